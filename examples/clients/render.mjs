#!/usr/bin/env node
// SPDX-License-Identifier: MIT
// Sends a scene to a running Penumbra and saves the picture. Needs Node 18 or later, no packages.
import { readFile, writeFile } from "node:fs/promises";
import { stdin, stdout, stderr, argv, env, exit } from "node:process";

const usage = `usage: render.mjs SCENE.json|- [-o PICTURE] [--url http://127.0.0.1:8080]

PICTURE is scene.png unless given; "-" is standard output; a name ending in .pfm asks for the linear
picture. Exit codes: 0 the picture is there, 1 no answer, the service failed or the picture cannot be
written, 2 the request is wrong.
`;

function stop(code, text) {
    stderr.write(`render.mjs: ${text}\n`);
    exit(code);
}

function readArguments() {
    const options = { scene: "", output: "scene.png", url: env.PENUMBRA_URL ?? "http://127.0.0.1:8080" };
    const rest = argv.slice(2);
    const names = { "-o": "output", "--output": "output", "--url": "url" };
    while (rest.length > 0) {
        const word = rest.shift();
        if (word === "-h" || word === "--help") {
            stdout.write(usage);
            exit(0);
        } else if (word in names) {
            if (rest.length === 0) stop(2, `${word} needs a value`);
            options[names[word]] = rest.shift();
        } else if (word.startsWith("-") && word !== "-") {
            stop(2, `unknown option ${word} (see render.mjs --help)`);
        } else if (options.scene) {
            stop(2, "one scene only");
        } else {
            options.scene = word;
        }
    }
    if (!options.scene) {
        stderr.write(usage);
        exit(2);
    }
    return options;
}

async function readScene(name) {
    if (name !== "-") return readFile(name);
    const parts = [];
    for await (const part of stdin) parts.push(part);
    return Buffer.concat(parts);
}

// A refusal as text: a title, then one line for each problem of the scene.
function explain(status, body) {
    const lines = [`the service answered ${status}`];
    try {
        const problem = JSON.parse(body);
        lines.push([problem.title, problem.detail].filter(Boolean).join(": "));
        for (const error of problem.errors ?? []) {
            const pointer = error.pointer ?? "";
            const spot = error.line ? `line ${error.line}, column ${error.column}` : "";
            const place = pointer && spot ? `${pointer} (${spot})` : pointer + spot;
            lines.push(`  ${place}: ${error.detail ?? error.message ?? ""}`);
        }
    } catch {
        lines.push(body);
    }
    return lines.join("\n");
}

const { scene, output, url } = readArguments();
const text = await readScene(scene).catch((error) => stop(2, `cannot read ${scene}: ${error.code ?? error.message}`));
const accept = output.endsWith(".pfm") ? "image/x-pfm" : "image/png";
let answer;
try {
    answer = await fetch(`${url.replace(/\/$/, "")}/v1/render`, {
        method: "POST",
        headers: { "Content-Type": "application/json", Accept: `${accept}, application/problem+json` },
        body: text,
    });
} catch (error) {
    stop(1, `no answer from ${url}: ${error.cause?.code ?? error.message}`);
}
if (!answer.ok) stop(answer.status < 500 ? 2 : 1, explain(answer.status, await answer.text()));
const picture = Buffer.from(await answer.arrayBuffer());
if (output === "-") {
    stdout.write(picture);
} else {
    await writeFile(output, picture).catch((error) => stop(1, `cannot write ${output}: ${error.code ?? error.message}`));
    console.log(`${output}: ${picture.length} bytes`);
}
