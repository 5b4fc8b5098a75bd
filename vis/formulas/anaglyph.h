#pragma once

#include "volume/base/numbers.h"

/// Two pictures in one, for glasses with a red filter before the left eye and a cyan one before the right.
namespace tessera::vis {

/// Linear light of both pictures in one: what, through the filters, is nearest to them in CIE XYZ by least squares, for
/// the phosphors of usual screens. E. Dubois: A projection method to generate anaglyph stereo images, 2001.
template <class N> glm::vec<3, N> anaglyphColor(const glm::vec<3, N>& left, const glm::vec<3, N>& right) {
    const N red = left.x * N(0.4561) + left.y * N(0.500484) + left.z * N(0.176381) - right.x * N(0.0434706) -
                  right.y * N(0.0879388) - right.z * N(0.00155529);
    const N green = right.x * N(0.378476) + right.y * N(0.73364) - right.z * N(0.0184503) - left.x * N(0.0400822) -
                    left.y * N(0.0378246) - left.z * N(0.0157589);
    const N blue = right.z * N(1.2264) - right.x * N(0.0721527) - right.y * N(0.112961) - left.x * N(0.0152161) -
                   left.y * N(0.0205971) - left.z * N(0.00546856);
    return glm::vec<3, N>(clamped(red, N(0), N(1)), clamped(green, N(0), N(1)), clamped(blue, N(0), N(1)));
}

} // namespace tessera::vis
