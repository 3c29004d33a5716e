// SPDX-License-Identifier: MIT
#include "core/gl/timer.h"

namespace penumbra::gl {

PassTimer::~PassTimer() {
    if (!queries_.empty()) glDeleteQueries(static_cast<GLsizei>(queries_.size()), queries_.data());
}

void PassTimer::mark() {
    if (used_ == queries_.size()) {
        GLuint query = 0;
        glGenQueries(1, &query);
        queries_.push_back(query);
    }
    glQueryCounter(queries_[used_++], GL_TIMESTAMP);
    // NVIDIA 580 stamps the last mark before a wait at the end of that wait unless the mark was sent off at once.
    if (used_ % 2 == 0) glFlush();
}

std::vector<double> PassTimer::read() {
    std::vector<double> result;
    for (std::size_t i = 0; i + 1 < used_; i += 2) {
        GLuint64 begin = 0;
        GLuint64 end = 0;
        glGetQueryObjectui64v(queries_[i], GL_QUERY_RESULT, &begin);
        glGetQueryObjectui64v(queries_[i + 1], GL_QUERY_RESULT, &end);
        result.push_back(end > begin ? static_cast<double>(end - begin) * 1e-6 : 0.0);
    }
    used_ = 0;
    return result;
}

}  // namespace penumbra::gl
