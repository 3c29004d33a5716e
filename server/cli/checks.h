// SPDX-License-Identifier: MIT
// What values the options take, in the words that the problems of a scene use: "must be ..., is ...".
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace penumbra {

CLI::Validator whole_number(long low, long high);
CLI::Validator number_between(double low, double high);
CLI::Validator number_of_at_least(double low);
CLI::Validator number_of_more_than(double low);
CLI::Validator one_of(std::vector<std::string> words);  // in upper or lower case
CLI::Validator readable_file();
CLI::Validator device_name();

}  // namespace penumbra
