#include "app/views/tesseract/tesseract_turn.h"

namespace tessera::app {

std::vector<double> anglesOf(const TesseractView& view, int axes) {
    std::vector<double> out{double(view.turn.x),  double(view.turn.y),  double(view.turn.z),
                            double(view.turn4.x), double(view.turn4.y), double(view.turn4.z)};
    out.resize(std::size_t(vis::planeCount(axes)), 0);
    for (std::size_t i = 6; i < out.size() && i - 6 < view.turnMore.size(); ++i) out[i] = double(view.turnMore[i - 6]);
    return out;
}

void setAngles(TesseractView& view, const std::vector<double>& angles) {
    view.turn = {angles[0], angles[1], angles[2]};
    view.turn4 = {angles[3], angles[4], angles[5]};
    view.turnMore.assign(angles.begin() + 6, angles.end());
}

void turn(TesseractView& view, int axes, const vis::RotationN& by) {
    setAngles(view, vis::anglesOf(by * vis::rotationOf(anglesOf(view, axes)), axes));
}

} // namespace tessera::app
