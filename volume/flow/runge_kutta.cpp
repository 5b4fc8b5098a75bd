#include "volume/flow/runge_kutta.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tessera::volume {

FlowStep flowStep(const ChangingField& field, glm::dvec3 from, double time, glm::dvec3 slope, double h,
                  glm::dvec3 cell) {
    FlowStep out;
    glm::dvec3 k[7] = {slope};
    const auto ask = [&](int stage, double share, glm::dvec3 way) {
        out.end = from + h * way;
        const double reach = glm::length(h * way / cell);
        const std::optional<glm::dvec3> vector = field(out.end, time + h * share);
        out.reach = vector ? std::max(out.reach, reach) : reach;
        if (vector) k[stage] = *vector;
        return vector.has_value();
    };
    out.present =
        ask(1, 0.2, k[0] / 5.0) && ask(2, 0.3, k[0] * (3.0 / 40) + k[1] * (9.0 / 40)) &&
        ask(3, 0.8, k[0] * (44.0 / 45) - k[1] * (56.0 / 15) + k[2] * (32.0 / 9)) &&
        ask(4, 8.0 / 9,
            k[0] * (19372.0 / 6561) - k[1] * (25360.0 / 2187) + k[2] * (64448.0 / 6561) - k[3] * (212.0 / 729)) &&
        ask(5, 1,
            k[0] * (9017.0 / 3168) - k[1] * (355.0 / 33) + k[2] * (46732.0 / 5247) + k[3] * (49.0 / 176) -
                k[4] * (5103.0 / 18656)) &&
        ask(6, 1,
            k[0] * (35.0 / 384) + k[2] * (500.0 / 1113) + k[3] * (125.0 / 192) - k[4] * (2187.0 / 6784) +
                k[5] * (11.0 / 84));
    if (!out.present) return out;
    out.slope = k[6];
    const glm::dvec3 difference = k[0] * (71.0 / 57600) - k[2] * (71.0 / 16695) + k[3] * (71.0 / 1920) -
                                  k[4] * (17253.0 / 339200) + k[5] * (22.0 / 525) - k[6] * (1.0 / 40);
    out.error = glm::length(h * difference / cell);
    return out;
}

double stepFactor(double tolerance, double error) {
    return std::clamp(0.9 * std::pow(tolerance / std::max(error, 1e-300), 0.2), 0.2, 5.0);
}

} // namespace tessera::volume
