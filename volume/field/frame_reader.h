#pragma once

#include "volume/field/slices.h"

#include <concepts>
#include <functional>
#include <utility>

namespace tessera::volume {

/// Reads frames of a data set, whole or some of their slices: calling it gives one stored component. May be called
/// from any thread, one call at a time per data set; throws Error when the file is bad.
class FrameReader {
public:
    using Read = std::function<Field(int parameter, int component, int time, SliceRange slices)>;

    FrameReader() = default;
    /// From a function (parameter, component, time, slices) that reads no more than these slices.
    template <std::invocable<int, int, int, SliceRange> F>
    requires(!std::same_as<F, FrameReader>) FrameReader(F read) : read_(std::move(read)), inParts_(true) {}
    /// From a function (parameter, component, time) that gives whole frames, out of which slices are cut.
    template <std::invocable<int, int, int> F>
    requires(!std::invocable<F, int, int, int, SliceRange>) FrameReader(F whole)
        : read_([whole = std::move(whole)](int parameter, int component, int time, SliceRange slices) {
              return cut(whole(parameter, component, time), slices);
          }) {}

    Field operator()(int parameter, int component, int time, SliceRange slices = {}) const {
        return read_(parameter, component, time, slices);
    }
    /// Whether slices are read without the rest of their frame.
    bool inParts() const { return inParts_; }

    /// Frames made of those of this one, in parts where these are: `make(read, parameter, component, time, slices)`.
    template <class Make> FrameReader through(Make make) const {
        FrameReader out;
        out.read_ = [read = *this, make = std::move(make)](int parameter, int component, int time, SliceRange slices) {
            return make(read, parameter, component, time, slices);
        };
        out.inParts_ = inParts_;
        return out;
    }

private:
    static Field cut(Field whole, SliceRange slices);

    Read read_;
    bool inParts_ = false;
};

} // namespace tessera::volume
