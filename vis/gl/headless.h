#pragma once

#include <memory>

namespace tessera::vis {

/// An off-screen GL 4.5 core context (EGL without a surface; works on Mesa's software GL and on GPU drivers), current
/// on the thread that made it until destroyed. Throws MachineError when none can be had, saying what was tried.
class HeadlessContext {
public:
    explicit HeadlessContext(bool debug = false);
    ~HeadlessContext();
    HeadlessContext(const HeadlessContext&) = delete;
    HeadlessContext& operator=(const HeadlessContext&) = delete;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace tessera::vis
