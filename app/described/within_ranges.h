#pragma once

#include "app/described/value.h"

namespace tessera::app {

namespace detail {

void keepWithinRanges(Value value, const FieldInfo& info);

} // namespace detail

/// Moves every number of a described struct that lies outside of its described range to the nearer end, what is not a
/// number to the lower one: a document with others is refused when it is read. For values that were computed from data.
template <class T> void keepWithinRanges(T& value) {
    detail::keepWithinRanges(valueOf(value), FieldInfo{"", ""});
}

} // namespace tessera::app
