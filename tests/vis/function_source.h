#pragma once

#include "volume/bricks/brick_source.h"

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tessera::vis {

/// A BrickSource whose channels are functions of the position, absent where they give nothing. The lattice replaces,
/// or is, a CC grid of `size` samples over the box 0..(size - 1) * spacing. `inset`: parts of a cell by which the
/// bounds that are shown lie inside that box, so that rays and samples do not fall on lattice planes.
class FunctionSource : public volume::BrickSource {
public:
    using Function = std::function<std::optional<double>(glm::dvec3 position)>;
    struct Channel {
        std::string name;
        Function function;
        Range range{0, 1};
        bool categorical = false;
        volume::Parts parts = {};
    };

    FunctionSource(volume::LatticeKind kind, glm::ivec3 size, glm::dvec3 spacing, std::vector<Channel> channels,
                   int brickSize = 8, glm::dvec3 inset = glm::dvec3(0))
        : channels_(std::move(channels)) {
        volume::Lattice lattice;
        lattice.size = size;
        lattice.spacing = spacing;
        info_.bounds = {inset * spacing, (glm::dvec3(size - 1) - inset * 0.7) * spacing};
        if (kind == volume::LatticeKind::BCC) lattice = volume::bccFor(lattice);
        info_.name = "function";
        info_.lattice = lattice;
        grid_.lattice = lattice;
        grid_.brickSize = brickSize;
        grid_.levels = 1;
        while ((2 << grid_.levels) <= brickSize && grid_.levels < 3) ++grid_.levels;
        for (const Channel& channel : channels_) {
            volume::Parameter parameter;
            parameter.name = channel.name;
            parameter.categorical = channel.categorical;
            parameter.ranges = {channel.range};
            parameter.parts = channel.parts;
            info_.parameters.push_back(parameter);
        }
    }

    const volume::DatasetInfo& info() const override { return info_; }
    const volume::BrickGrid& grid() const override { return grid_; }
    volume::BrickStats stats(const volume::BrickKey& key) const override {
        volume::BrickKey fine = key;
        fine.level = 0;
        const volume::BrickSamples samples = read(fine);
        volume::BrickStats stats{std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(), 0};
        std::size_t present = 0;
        for (std::size_t i = 0; i < samples.values.size(); ++i) {
            if (!samples.isPresent(i)) continue;
            stats.min = std::min(stats.min, samples.values[i]);
            stats.max = std::max(stats.max, samples.values[i]);
            ++present;
        }
        stats.presentFraction = float(present) / float(samples.values.size());
        return stats;
    }
    volume::BrickSamples read(const volume::BrickKey& key) const override {
        const int perTexel = grid_.lattice.kind == volume::LatticeKind::BCC ? 2 : 1;
        const glm::ivec3 begin = grid_.begin(key.index);
        volume::BrickSamples out;
        out.size = grid_.brickSamples(key.index, key.level);
        bool all = true;
        for (int z = 0; z < out.size.z; ++z)
            for (int y = 0; y < out.size.y; ++y)
                for (int x = 0; x < out.size.x; ++x) {
                    const glm::ivec3 at(begin.x + (x << key.level), begin.y + (y << key.level),
                                        begin.z + ((z / perTexel) << key.level) * perTexel + z % perTexel);
                    const std::optional<double> value =
                        channels_[std::size_t(key.channel)].function(grid_.lattice.position(at));
                    out.values.push_back(float(value.value_or(-1e6))); // must never show
                    out.present.push_back(value.has_value());
                    all = all && value.has_value();
                }
        if (all) out.present.clear();
        return out;
    }

private:
    volume::DatasetInfo info_;
    volume::BrickGrid grid_;
    std::vector<Channel> channels_;
};

} // namespace tessera::vis
