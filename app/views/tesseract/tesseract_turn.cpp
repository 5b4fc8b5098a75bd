#include "app/views/tesseract/tesseract_turn.h"

namespace tessera::app {

vis::Angles4 anglesOf(const TesseractView& view) {
    return {double(view.turn.x),  double(view.turn.y),  double(view.turn.z),
            double(view.turn4.x), double(view.turn4.y), double(view.turn4.z)};
}

void setAngles(TesseractView& view, const vis::Angles4& angles) {
    view.turn = {angles[0], angles[1], angles[2]};
    view.turn4 = {angles[3], angles[4], angles[5]};
}

void turn(TesseractView& view, vis::Plane4 a, double first, vis::Plane4 b, double second) {
    const glm::dmat4 now = vis::rotationOf(anglesOf(view));
    setAngles(view, vis::anglesOf(vis::planeRotation(a, first) * vis::planeRotation(b, second) * now));
}

} // namespace tessera::app
