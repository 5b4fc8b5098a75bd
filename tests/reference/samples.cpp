#include "tests/reference/samples.h"

#include "volume/base/parallel.h"
#include "volume/bricks/parts_bricks.h"
#include "volume/bricks/source_at_time.h"

#include <algorithm>
#include <cassert>
#include <limits>

namespace tessera::vis::reference {

namespace {

constexpr int kMargin = 4; ///< samples of each sublattice beyond the lattice, for filter, gradient and the shift of BCC
constexpr int kMarginOfCubic = 2; ///< the same as pictures have it

std::size_t linearIndex(glm::ivec3 size, glm::ivec3 at) {
    return (std::size_t(at.z) * std::size_t(size.y) + std::size_t(at.y)) * std::size_t(size.x) + std::size_t(at.x);
}

/// All samples of a lattice, gathered brick by brick; beyond it the nearest sample of the same sublattice.
struct Whole {
    volume::Lattice lattice;
    std::vector<float> values;
    std::vector<std::uint8_t> present; // empty: all

    /// `brick` reads one brick.
    Whole(const volume::BrickSource& source, const std::function<volume::BrickSamples(glm::ivec3)>& brick,
          bool ignoredMask)
        : lattice(source.grid().lattice), values(lattice.count()) {
        const volume::BrickGrid& grid = source.grid();
        const glm::ivec3 count = grid.count();
        for (int z = 0; z < count.z; ++z)
            for (int y = 0; y < count.y; ++y)
                for (int x = 0; x < count.x; ++x) insert(grid.begin({x, y, z}), brick({x, y, z}), ignoredMask);
    }
    void insert(glm::ivec3 begin, const volume::BrickSamples& brick, bool ignoredMask) {
        const bool masked = !brick.present.empty();
        if (masked && !ignoredMask && present.empty()) present.assign(values.size(), 1);
        for (int z = 0; z < brick.size.z; ++z)
            for (int y = 0; y < brick.size.y; ++y)
                for (int x = 0; x < brick.size.x; ++x) {
                    const std::size_t from = linearIndex(brick.size, {x, y, z});
                    const std::size_t to = lattice.index(begin + glm::ivec3(x, y, z));
                    const bool there = !masked || brick.present[from] != 0;
                    values[to] = there ? brick.values[from] : 0;
                    if (!there && !ignoredMask) present[to] = 0;
                }
    }
    volume::Sample operator()(glm::ivec3 at) const {
        const std::size_t i = lattice.index(volume::clampToLattice(lattice.kind, lattice.size, at));
        return {double(values[i]), volume::isPresent(present, i)};
    }
};

} // namespace

/// The samples visible to a reading: all, or only those of one brick to simulate missing halos.
struct Samples::View {
    const Samples& all;
    glm::ivec3 lo, hi; // range of readable storage indices, inclusive
    int slices;

    volume::Sample operator()(glm::ivec3 at) const {
        const int parity = at.z & (slices - 1);
        at = glm::clamp(at, lo, hi);
        if (slices == 2 && (at.z & 1) != parity) at.z += at.z == hi.z ? -1 : 1;
        const std::size_t i = linearIndex(all.size_, at - all.first_);
        return {all.values_[i], all.present_.empty() || all.present_[i] != 0};
    }
};

/// All samples, for positions far from the border: the same without clamping.
struct Samples::Inside {
    const double* values;
    const std::uint8_t* present;      // null: all
    std::ptrdiff_t row, slice, first; ///< samples of each, and the place of index 0

    Inside(const Samples& all)
        : values(all.values_.data()), present(all.present_.empty() ? nullptr : all.present_.data()), row(all.size_.x),
          slice(row * all.size_.y), first(-(all.first_.z * slice + all.first_.y * row + all.first_.x)) {}
    volume::Sample operator()(glm::ivec3 at) const {
        const std::ptrdiff_t i = first + at.z * slice + at.y * row + at.x;
        return {values[i], present == nullptr || present[i] != 0};
    }
};

Samples::Samples(const volume::BrickSource& source, int channel, volume::TimePair time, Filter filter,
                 const Flaws& flaws)
    : Samples(source, channel, time, filter, flaws, std::nullopt) {}

Samples::Samples(const volume::BrickSource& given, int channel, volume::TimePair time, Filter filter,
                 const Flaws& flaws, std::optional<OnePart> only)
    : geometry_(volume::levelGeometry(given.grid(), 0)), filter_(filter), flaws_(flaws),
      brickSize_(given.grid().brickSize) {
    const std::shared_ptr<const volume::BrickSource> borrowed(std::shared_ptr<const volume::BrickSource>(), &given);
    const volume::SourceAtTime now = time.between() && volume::isComputedBetween(given, channel)
                                         ? volume::sourceAt(borrowed, time)
                                         : volume::SourceAtTime{borrowed, 0};
    if (now.source != borrowed) time = {now.time, now.time, 0};
    const volume::BrickSource& source = *now.source;
    const volume::DatasetInfo& info = source.info();
    const volume::Parameter& parameter = info.parameters[std::size_t(info.channel(channel).parameter)];
    categorical_ = parameter.categorical;
    const std::optional<int> label = volume::labelChannel(info, parameter);
    if (label && !only && !flaws.mixedParts) {
        for (std::size_t part = 0; part < parameter.parts.count(); ++part)
            parts_.push_back(std::unique_ptr<Samples>(
                new Samples(source, channel, time, filter, flaws, OnePart{*label, parameter.parts, part})));
        return;
    }
    if (categorical_) time = {time.nearest(), time.nearest(), 0};
    if (time.between()) {
        laterWeight_ = time.weight;
        later_ = std::unique_ptr<Samples>(
            new Samples(source, channel, volume::TimePair{time.later, time.later, 0}, filter, flaws, only));
    }
    const auto brick = [&](glm::ivec3 index) {
        volume::BrickSamples samples = source.read({channel, time.earlier, 0, index});
        if (!only) return samples;
        return volume::onlyPart(std::move(samples), source.read({only->label, time.earlier, 0, index}), only->parts,
                                only->part);
    };
    const Whole whole(source, brick, flaws.ignoredMask && !only);
    const int slices = geometry_.kind == volume::LatticeKind::BCC ? 2 : 1;
    const bool cubic = filter == Filter::Cubic && !categorical_;
    unread_ = cubic ? volume::prefilterReach(volume::Prefilter::Cubic, geometry_) : 0;
    const int own = cubic ? kMarginOfCubic : kMargin;
    const glm::ivec3 margin = glm::ivec3(1, 1, slices) * (own + unread_);
    first_ = -margin;
    size_ = whole.lattice.texels() * glm::ivec3(1, 1, slices) + 2 * margin;
    innerLo_ = glm::dvec3(2 - own + (cubic ? 1 : 0));
    innerHi_ = glm::dvec3(whole.lattice.texels() + own - 3 - (cubic ? 1 : 0));
    values_.resize(std::size_t(size_.x) * std::size_t(size_.y) * std::size_t(size_.z));
    if (!whole.present.empty()) present_.resize(values_.size());
    const bool prefiltered = filter == Filter::AverageQuasi && !categorical_ && !flaws.unfiltered;
    const volume::Prefiltered<Whole> filtered(whole, geometry_);
    parallelFor(std::size_t(size_.z), [&](std::size_t z) {
        for (int y = 0; y < size_.y; ++y)
            for (int x = 0; x < size_.x; ++x) {
                const glm::ivec3 at(x, y, int(z));
                const volume::Sample sample = prefiltered ? filtered(first_ + at) : whole(first_ + at);
                const std::size_t to = linearIndex(size_, at);
                values_[to] = sample.value;
                if (!present_.empty()) present_[to] = sample.present;
            }
    });
    if (cubic && !flaws.unfiltered) makeCoefficients();
}

/// The steps of volume/reconstruct/cubic.h, sample by sample.
void Samples::makeCoefficients() {
    const bool bcc = geometry_.bccNeighbours();
    const int slices = geometry_.kind == volume::LatticeKind::BCC ? 2 : 1;
    const View all{*this, first_, first_ + size_ - 1, slices};
    const std::vector<double> samples = values_;
    // Around an even sample, in half cells: weights of all others that its kernel reaches.
    std::vector<std::pair<glm::ivec3, double>> kernel;
    for (int z = -3; z <= 3; ++z)
        for (int y = -3; y <= 3; ++y)
            for (int x = -3; x <= 3; ++x) {
                if ((z & 1) != (y & 1) || (z & 1) != (x & 1) || ((z & 1) != 0 && !bcc)) continue;
                const auto along = [](int half) {
                    const double far = std::abs(half) / 2.0;
                    return far < 1   ? (4 - 6 * far * far + 3 * far * far * far) / 6
                           : far < 2 ? (2 - far) * (2 - far) * (2 - far) / 6
                                     : 0;
                };
                kernel.emplace_back(glm::ivec3(x, y, z), along(x) * along(y) * along(z) * (bcc ? 0.5 : 1));
            }
    for (const double factor : volume::cubicSteps(geometry_)) {
        std::vector<double> next = values_;
        parallelFor(std::size_t(size_.z), [&](std::size_t slice) {
            for (int y = 0; y < size_.y; ++y)
                for (int x = 0; x < size_.x; ++x) {
                    const glm::ivec3 at = first_ + glm::ivec3(x, y, int(slice));
                    const std::size_t i = linearIndex(size_, at - first_);
                    if (!present_.empty() && present_[i] == 0) continue;
                    const int odd = slices == 2 ? at.z & 1 : 0;
                    double smooth = 0;
                    for (const auto& [away, weight] : kernel) {
                        // An even sample at half cells 2 i, an odd one at 2 i + 1.
                        const glm::ivec3 half = 2 * glm::ivec3(at.x, at.y, 0) + odd + away;
                        const volume::Sample one =
                            all({half.x >> 1, half.y >> 1, at.z + (slices == 2 ? away.z : away.z / 2)});
                        smooth += weight * (one.present ? one.value : values_[i]);
                    }
                    next[i] = values_[i] + factor * (samples[i] - smooth);
                }
        });
        values_ = std::move(next);
    }
}

Range Samples::bounds(glm::ivec3 begin, glm::ivec3 end) const {
    const int slices = geometry_.kind == volume::LatticeKind::BCC ? 2 : 1;
    const glm::ivec3 steps(1, 1, slices), from = glm::max(begin * steps, first_) - first_,
                                          to = glm::min(end * steps, first_ + size_) - first_;
    Range out{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (const auto& part : parts_) {
        const Range own = part->bounds(begin, end);
        out = {std::min(out.lo, own.lo), std::max(out.hi, own.hi)};
    }
    if (!parts_.empty()) return out;
    for (int z = from.z; z < to.z; ++z)
        for (int y = from.y; y < to.y; ++y)
            for (int x = from.x; x < to.x; ++x) {
                const std::size_t i = linearIndex(size_, {x, y, z});
                if (!present_.empty() && present_[i] == 0) continue;
                out = {std::min(out.lo, values_[i]), std::max(out.hi, values_[i])};
            }
    if (!later_) return out;
    const Range later = later_->bounds(begin, end);
    return {std::min(out.lo, later.lo), std::max(out.hi, later.hi)};
}

bool Samples::someAbsent() const {
    if (!parts_.empty()) return true;
    return std::ranges::find(present_, 0) != present_.end() || (later_ && later_->someAbsent());
}

Samples::View Samples::view() const {
    const int slices = geometry_.kind == volume::LatticeKind::BCC ? 2 : 1;
    const glm::ivec3 unread = glm::ivec3(1, 1, slices) * unread_;
    return {*this, first_ + unread, first_ + size_ - 1 - unread, slices};
}

template <class Read> volume::Blend Samples::filtered(const Read& samples, glm::dvec3 cells) const {
    volume::Blend blend;
    if (categorical_) {
        blend.add(1, volume::nearest(geometry_, samples, cells));
    } else if (flaws_.unmovedSublattice && geometry_.kind == volume::LatticeKind::BCC) {
        for (int s = 0; s < 2; ++s) volume::addTrilinear(blend, samples, geometry_.toSublattice(cells, 0), s, 2, 0.5);
    } else {
        blend = filter_ == Filter::Tetrahedral ? volume::tetrahedral(geometry_, samples, cells)
                : filter_ == Filter::Cubic     ? volume::cubic(geometry_, samples, cells)
                                               : volume::linear(geometry_, samples, cells);
    }
    return blend;
}

volume::Blend Samples::blend(glm::dvec3 cells) const {
    volume::Blend blend;
    if (!flaws_.clampedBricks && glm::clamp(cells, innerLo_, innerHi_) == cells) {
        blend = filtered(Inside(*this), cells);
    } else {
        View here = view();
        if (flaws_.clampedBricks) {
            const glm::ivec3 brick = glm::ivec3(glm::floor(cells / double(brickSize_))), steps(1, 1, here.slices);
            here.lo = glm::clamp(brick * brickSize_ * steps, here.lo, here.hi);
            here.hi = glm::clamp((brick + 1) * brickSize_ * steps - 1, here.lo, here.hi);
        }
        blend = filtered(here, cells);
    }
    if (!later_) return blend;
    const volume::Blend later = later_->blend(cells);
    return {(1 - laterWeight_) * blend.sum + laterWeight_ * later.sum,
            (1 - laterWeight_) * blend.coverage + laterWeight_ * later.coverage};
}

std::optional<Reading> Samples::read(glm::dvec3 cells) const {
    if (parts_.empty()) {
        const std::optional<double> value = blend(cells).value();
        return value ? std::optional(Reading{*value, 0}) : std::nullopt;
    }
    volume::PartChoice choice;
    double sum = 0;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const volume::Blend own = parts_[i]->blend(cells);
        if (choice.add(int(i), own.coverage)) sum = own.sum;
    }
    if (choice.total < volume::kPresentCoverage) return std::nullopt;
    return Reading{sum / choice.coverage, int(choice.part)};
}

std::optional<double> Samples::value(glm::dvec3 cells) const {
    const std::optional<Reading> found = read(cells);
    return found ? std::optional(found->value) : std::nullopt;
}

int Samples::part(glm::dvec3 cells) const {
    volume::PartChoice choice;
    for (std::size_t i = 0; i < parts_.size(); ++i) choice.add(int(i), parts_[i]->blend(cells).coverage);
    return int(choice.part);
}

std::optional<double> Samples::ofPart(int part, glm::dvec3 cells) const {
    return (parts_.empty() ? *this : *parts_[std::size_t(part)]).blend(cells).value();
}

double Samples::continued(int part, glm::dvec3 cells) const {
    const volume::Blend blend = (parts_.empty() ? *this : *parts_[std::size_t(part)]).blend(cells);
    return blend.coverage > 0 ? blend.sum / blend.coverage : std::numeric_limits<double>::quiet_NaN();
}

Samples::ColorBlend Samples::colorBlend(glm::dvec3 cells, const std::function<glm::dvec4(double)>& of) const {
    const auto sampleAt = [this, here = view()](glm::ivec3 at) {
        const volume::Sample sample = here(at);
        if (!later_) return sample;
        volume::Blend both;
        both.add(1 - laterWeight_, sample);
        both.add(laterWeight_, later_->view()(at));
        const std::optional<double> value = both.value();
        return volume::Sample{value.value_or(0), value.has_value()};
    };
    struct Colored {
        glm::dvec4 color;
        bool present;
    };
    std::vector<Colored> around; // the samples that linear() reads, in its order, which is the same for each component
    around.reserve(16);
    ColorBlend out;
    for (int c = 0; c < 4; ++c) {
        std::size_t next = 0;
        const auto component = [&](glm::ivec3 at) {
            if (c == 0) {
                const volume::Sample sample = sampleAt(at);
                around.push_back({sample.present ? of(sample.value) : glm::dvec4(0), sample.present});
            }
            const Colored& one = around[next++];
            return volume::Sample{one.color[c], one.present};
        };
        const volume::Blend blend = volume::linear(geometry_, component, cells);
        out.sum[c] = blend.sum;
        out.coverage = blend.coverage;
    }
    return out;
}

std::optional<glm::dvec4> Samples::blended(glm::dvec3 cells, const std::function<glm::dvec4(double)>& of) const {
    volume::PartChoice choice;
    glm::dvec4 sum(0);
    for (std::size_t i = 0; i < std::max<std::size_t>(parts_.size(), 1); ++i) {
        const ColorBlend own = (parts_.empty() ? *this : *parts_[i]).colorBlend(cells, of);
        if (choice.add(int(i), own.coverage)) sum = own.sum;
    }
    if (choice.total < volume::kPresentCoverage) return std::nullopt;
    return sum / choice.coverage;
}

} // namespace tessera::vis::reference
