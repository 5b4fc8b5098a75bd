#include "tests/vis/gl_fixture.h"

#include <cmath>
#include <limits>

namespace tessera::test {

namespace {

/// Bricks straight from formulas, without any file or resampling.
class FormulaSource : public volume::BrickSource {
public:
    FormulaSource(glm::ivec3 size, std::vector<Formula> formulas, const GridOptions& options)
        : formulas_(std::move(formulas)) {
        volume::Lattice cc;
        cc.size = size;
        cc.spacing = options.spacing;
        grid_.lattice = options.lattice == volume::LatticeKind::CC ? cc : volume::bccFor(cc);
        grid_.brickSize = options.brickSize;
        grid_.levels = 1;
        while (grid_.levels < 4 && (2 << grid_.levels) <= options.brickSize) ++grid_.levels;
        info_.lattice = grid_.lattice;
        info_.bounds = {glm::dvec3(0), glm::dvec3(size - 1) * options.spacing};
        spacing_ = options.spacing;
        info_.times.clear();
        for (int t = 0; t < options.times; ++t) info_.times.push_back(t);
        for (std::size_t f = 0; f < formulas_.size(); ++f) {
            volume::Parameter parameter;
            parameter.name = formulas_[f].name;
            parameter.categorical = formulas_[f].categorical;
            Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
            for (std::size_t i = 0; i < grid_.lattice.count(); ++i) {
                const glm::ivec3 n = grid_.lattice.size;
                const auto [value, present] = sample(f, {int(i) % n.x, int(i) / n.x % n.y, int(i) / n.x / n.y}, 0);
                if (present) range = {std::min(range.lo, value), std::max(range.hi, value + options.times - 1)};
            }
            parameter.ranges = {range};
            info_.parameters.push_back(parameter);
        }
    }
    const volume::DatasetInfo& info() const override { return info_; }
    const volume::BrickGrid& grid() const override { return grid_; }
    volume::BrickSamples read(const volume::BrickKey& key) const override {
        volume::BrickSamples out;
        out.size = grid_.brickSamples(key.index, key.level);
        const glm::ivec3 first = grid_.levelBegin(key.index, key.level);
        const bool bcc = grid_.lattice.kind == volume::LatticeKind::BCC;
        for (int z = 0; z < out.size.z; ++z)
            for (int y = 0; y < out.size.y; ++y)
                for (int x = 0; x < out.size.x; ++x) {
                    glm::ivec3 at = first + glm::ivec3(x, y, z);
                    // Level samples lie on every 2^l-th fine one of their sublattice.
                    const int parity = bcc ? at.z & 1 : 0;
                    at = bcc ? glm::ivec3(at.x << key.level, at.y << key.level, ((at.z >> 1) << key.level) * 2 + parity)
                             : at << key.level;
                    const auto [value, present] = sample(std::size_t(key.channel), at, key.time);
                    out.values.push_back(float(value));
                    out.present.push_back(present);
                }
        return out;
    }
    volume::BrickStats stats(const volume::BrickKey& key) const override {
        volume::BrickKey fine = key;
        fine.level = 0;
        const volume::BrickSamples samples = read(fine);
        volume::BrickStats stats{std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(), 0};
        for (std::size_t i = 0; i < samples.values.size(); ++i) {
            if (!samples.present[i]) continue;
            stats.min = std::min(stats.min, samples.values[i]);
            stats.max = std::max(stats.max, samples.values[i]);
            stats.presentFraction += 1;
        }
        stats.presentFraction /= float(samples.values.size());
        return stats;
    }

private:
    std::pair<double, bool> sample(std::size_t formula, glm::ivec3 at, int time) const {
        const glm::dvec3 cells = grid_.lattice.position(at) / spacing_;
        const Formula& f = formulas_[formula];
        return {f.value(cells) + (f.categorical ? 0 : time), !f.present || f.present(cells)};
    }
    std::vector<Formula> formulas_;
    glm::dvec3 spacing_{1};
    volume::DatasetInfo info_;
    volume::BrickGrid grid_;
};

} // namespace

std::shared_ptr<const volume::BrickSource> makeSource(glm::ivec3 size, const std::vector<Formula>& formulas,
                                                      const GridOptions& options) {
    return std::make_shared<FormulaSource>(size, formulas, options);
}

vis::Camera frontCamera(double extent) {
    vis::Camera camera;
    camera.projection = vis::Projection::Orthographic;
    camera.orientation = {1, 0, 0, 0};
    camera.fieldOfView = 30;
    camera.distance = float(extent / 2 / std::tan(15 * 3.14159265358979323846 / 180));
    return camera;
}

vis::FrameStatus renderAll(vis::Renderer& renderer, vis::ViewTarget& target, const vis::Scene& scene, glm::ivec2 size) {
    vis::FrameRequest request;
    request.size = size;
    request.wait = true;
    const vis::FrameStatus status = renderer.render(target, scene, request);
    EXPECT_TRUE(status.complete);
    return status;
}

double maxDifference(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b) {
    if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
    double worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        for (int c = 0; c < 4; ++c) worst = std::max(worst, std::abs(double(a[i][c]) - double(b[i][c])));
    return worst;
}

} // namespace tessera::test
