#include "vis/gl/draw_timer.h"

#include <chrono>

namespace tessera::vis {

void DrawTimer::measure(const std::function<void()>& draw, std::function<void(double)> took) {
    using Clock = std::chrono::steady_clock;
    if (!queries_) {
        const Clock::time_point begin = Clock::now();
        draw();
        glFinish();
        return took(std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
    }
    GLuint name = 0;
    glCreateQueries(GL_TIME_ELAPSED, 1, &name);
    pending_.push_back({Query(name), std::move(took)});
    glBeginQuery(GL_TIME_ELAPSED, name);
    draw();
    glEndQuery(GL_TIME_ELAPSED);
}

void DrawTimer::collect(bool wait) {
    while (!pending_.empty()) {
        const GLuint query = pending_.front().query.name();
        GLint here = GL_FALSE;
        glGetQueryObjectiv(query, GL_QUERY_RESULT_AVAILABLE, &here);
        if (!here && !wait) return;
        GLuint64 nanoseconds = 0;
        glGetQueryObjectui64v(query, GL_QUERY_RESULT, &nanoseconds);
        const std::function<void(double)> took = std::move(pending_.front().took);
        pending_.pop_front();
        took(double(nanoseconds) * 1e-6);
    }
}

} // namespace tessera::vis
