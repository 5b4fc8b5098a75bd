#pragma once

namespace tessera::volume {

/// What becomes of import options that fit nothing in the data. Sessions may hold units of other data.
enum class Misfits { Refused, Ignored };

} // namespace tessera::volume
