#pragma once

#include <memory>

namespace tessera::vis {

/// An off-screen GL 4.5 core context (EGL without a surface; works with Mesa's software GL and GPU drivers), current on
/// the creating thread until destroyed. Throws MachineError with the attempts made if none is available.
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
