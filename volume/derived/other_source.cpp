#include "volume/derived/other_source.h"

#include "volume/base/error.h"
#include "volume/bricks/brick_cache.h"
#include "volume/bricks/brick_source.h"
#include "volume/bricks/sample_position.h"
#include "volume/reconstruct/probe.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <limits>

namespace tessera::volume {

namespace {

constexpr std::size_t kOtherBudget = std::size_t(192) << 20;
constexpr double kOtherRangeSamples = 3e6;

/// Units of length of `to` per one of `from`. One that states none is taken to have that of the other.
double lengthScale(const DatasetInfo& from, const DatasetInfo& to) {
    if (from.lengthUnit == to.lengthUnit || from.lengthUnit.empty() || to.lengthUnit.empty()) return 1;
    const auto conversion = unitConversion(from.lengthUnit, to.lengthUnit);
    if (!conversion)
        throw Error("lengths of " + from.name + " in " + from.lengthUnit + " and of " + to.name + " in " +
                    to.lengthUnit + " cannot be compared");
    // Of a power of ten and its inverse only one is exact: multiply or divide by that one.
    const double ratio = conversion->factor, whole = std::round(ratio >= 1 ? ratio : 1 / ratio);
    if (std::abs((ratio >= 1 ? ratio : 1 / ratio) - whole) > 1e-9 * whole) return ratio;
    return ratio >= 1 ? whole : 1 / whole;
}

bool near(glm::dvec3 a, glm::dvec3 b, glm::dvec3 scale) {
    return glm::all(glm::lessThanEqual(glm::abs(a - b), 1e-6 * glm::abs(scale)));
}

/// Whether the axes of a grid, in the unit of its lengths, are those of another one within 1e-6 of the cells there.
bool sameAxes(const AxisMaps& a, const AxisMaps& b, double scale) {
    for (int axis = 0; axis < 3; ++axis) {
        const AxisMap *own = a[axis], *other = b[axis];
        if (!own && !other) continue;
        if (!own || !other || own->of() != other->of() || own->samples() != other->samples()) return false;
        const std::vector<double>&planes = own->planes(), &others = other->planes();
        for (std::size_t i = 0; i < planes.size(); ++i) {
            const double cell = std::min(i > 0 ? planes[i] - planes[i - 1] : HUGE_VAL,
                                         i + 1 < planes.size() ? planes[i + 1] - planes[i] : HUGE_VAL);
            if (!(std::abs(planes[i] - others[i] * scale) <= 1e-6 * cell)) return false;
        }
    }
    return true;
}

/// Whether two grids have the same bricks with samples at the same positions.
bool sameSamples(const BrickGrid& a, const BrickGrid& b, double scale) {
    return a.lattice.kind == b.lattice.kind && a.lattice.size == b.lattice.size && a.brickSize == b.brickSize &&
           a.levels == b.levels && a.phase == b.phase &&
           near(a.lattice.spacing, b.lattice.spacing * scale, a.lattice.spacing / glm::dvec3(a.lattice.size)) &&
           near(a.lattice.origin, b.lattice.origin * scale, a.lattice.spacing) &&
           sameAxes(a.lattice.axes, b.lattice.axes, scale);
}

BrickSamples absentBrick(const BrickGrid& grid, const BrickKey& key) {
    BrickSamples out;
    out.size = grid.brickSamples(key.index, key.level);
    const auto count = std::size_t(out.size.x) * std::size_t(out.size.y) * std::size_t(out.size.z);
    out.values.assign(count, 0);
    out.present.assign(count, 0);
    return out;
}

} // namespace

SampledOnto::SampledOnto(const std::shared_ptr<const BrickSource>& source, const BrickSource& onto)
    : source_(std::make_shared<const BrickCache>(source, kOtherBudget)), grid_(onto.grid()),
      scale_(lengthScale(onto.info(), source->info())), sameGrid_(sameSamples(source->grid(), grid_, scale_)) {}

BrickSamples SampledOnto::read(const BrickSource& at, const BrickKey& key) const {
    if (sameGrid_) return at.read(key);
    const Box& box = at.info().bounds;
    std::vector<glm::dvec3> positions;
    BrickSamples out = absentBrick(grid_, key);
    SamplePositions position(grid_, key.index, key.level);
    for (std::size_t i = 0; i < out.values.size(); ++i, position.next()) {
        const glm::dvec3 wanted = position.at() * scale_, inside = glm::clamp(wanted, box.lo, box.hi);
        const glm::dvec3 slack = at.grid().lattice.lengthsAt(inside) * 1e-6;
        // Positions on the border are inside, regardless of rounding.
        positions.push_back(glm::all(glm::lessThanEqual(glm::abs(wanted - inside), slack)) ? inside : wanted);
    }
    const std::vector<ProbeValue> values = probeAlong(at, key.channel, positions, key.time);
    for (std::size_t i = 0; i < out.values.size(); ++i)
        if (const std::optional<double>& value = values[i].interpolated) {
            out.values[i] = float(*value);
            out.present[i] = 1;
        }
    if (std::ranges::find(out.present, std::uint8_t(0)) == out.present.end()) out.present.clear();
    return out;
}

namespace {

class WithOther final : public BrickSource {
public:
    WithOther(std::shared_ptr<const BrickSource> source, std::shared_ptr<const BrickSource> other)
        : source_(std::move(source)), other_(std::move(other)), onto_(other_, *source_), info_(source_->info()),
          own_(int(info_.channels().size())) {
        matchTimes();
        const bool single = info_.parameters.size() == 1 && other_->info().parameters.size() == 1;
        for (Parameter parameter : other_->info().parameters) {
            if (single) parameter.name = info_.parameters.front().name;
            parameter.name += kOtherSuffix;
            if (!parameter.parts.label.empty()) parameter.parts.label += kOtherSuffix;
            if (!onto_.sameGrid() && !parameter.categorical) parameter.type = ScalarType::F32;
            info_.parameters.push_back(std::move(parameter));
        }
        info_.provenance += (info_.provenance.empty() ? "" : "; ") + std::string("(other): ") + other_->info().name +
                            ", " + otherText(*source_, *other_);
    }

    const DatasetInfo& info() const override { return info_; }
    const BrickGrid& grid() const override { return source_->grid(); }
    BrickStats stats(const BrickKey& key) const override {
        if (key.channel < own_) return source_->stats(key);
        const auto& at = times_[std::size_t(key.time)];
        if (at && onto_.sameGrid()) return at->source->stats(inOther(key));
        BrickKey fine = key;
        fine.level = 0;
        return statsOfSamples(read(fine));
    }
    std::optional<BrickDistribution> distribution(const BrickKey& key) const override {
        if (key.channel < own_) return source_->distribution(key);
        return noted(key) ? other_->distribution(inOther(key)) : std::nullopt;
    }
    std::optional<BrickImportance> importance(const BrickKey& key) const override {
        if (key.channel < own_) return source_->importance(key);
        return noted(key) ? other_->importance(inOther(key)) : std::nullopt;
    }
    std::optional<BrickChange> change(const BrickKey& key, int toTime) const override {
        if (key.channel < own_) return source_->change(key, toTime);
        if (key.time == toTime) return BrickChange{};
        BrickKey to = key;
        to.time = toTime;
        if (noted(key) && noted(to)) return other_->change(inOther(key), inOther(to).time);
        // A single time is compared with every time.
        return times_[std::size_t(key.time)] && other_->info().times.size() == 1 ? std::optional(BrickChange{})
                                                                                 : std::nullopt;
    }
    BrickSamples read(const BrickKey& key) const override {
        if (key.channel < own_) return source_->read(key);
        const auto& at = times_[std::size_t(key.time)];
        return at ? onto_.read(*at->source, inOther(key)) : absentBrick(grid(), key);
    }
    const std::shared_ptr<const BrickSource>& own() const { return source_; }
    const std::shared_ptr<const BrickSource>& other() const { return other_; }

private:
    void matchTimes() {
        const std::vector<double>&own = info_.times, &all = other_->info().times;
        const std::string &unit = info_.timeUnit, &others = other_->info().timeUnit; // "": not stated, taken as equal
        if (all.size() > 1 && own.size() > 1 &&
            ((unit != others && !unit.empty() && !others.empty()) || info_.timeName != other_->info().timeName))
            throw Error("times in " + info_.timeName + " [" + info_.timeUnit + "] and " + other_->info().timeName +
                        " [" + other_->info().timeUnit + "] cannot be compared");
        const double slack = 1e-9 * std::max(std::abs(all.front()), std::abs(all.back()));
        for (const double time : own) {
            const bool there = all.size() == 1 || (time >= all.front() - slack && time <= all.back() + slack);
            times_.push_back(there ? std::optional(sourceAt(onto_.source(), timesAround(all, time))) : std::nullopt);
        }
    }
    /// Whether statistics of the other source's bricks are valid for this one.
    bool noted(const BrickKey& key) const {
        const auto& at = times_[std::size_t(key.time)];
        return at && onto_.sameGrid() && at->source == onto_.source();
    }
    BrickKey inOther(BrickKey key) const {
        key.channel -= own_;
        key.time = times_[std::size_t(key.time)]->time;
        return key;
    }

    std::shared_ptr<const BrickSource> source_, other_;
    SampledOnto onto_;
    DatasetInfo info_;
    int own_; ///< channels of the source
    std::vector<std::optional<SourceAtTime>> times_;
};

class Difference final : public BrickSource {
public:
    Difference(const FieldAt& of, const FieldAt& minus, const Progress& progress)
        : onto_(of.source, *minus.source), of_(sourceAt(onto_.source(), of.time)),
          minus_(sourceAt(minus.source, minus.time)), ofChannel_(of.channel), minusChannel_(minus.channel) {
        const DatasetInfo &left = of.source->info(), &right = minus.source->info();
        const Channel a = left.channel(of.channel), b = right.channel(minus.channel);
        const auto toUnit = unitConversion(b.unit, a.unit);
        if (!toUnit)
            throw Error(a.name + " in " + (a.unit.empty() ? "no unit" : a.unit) + " and " + b.name + " in " +
                        (b.unit.empty() ? "no unit" : b.unit) + " cannot be subtracted");
        toUnit_ = *toUnit;
        info_.name = left.name;
        info_.lattice = right.lattice;
        info_.bounds = right.bounds;
        info_.lengthUnit = right.lengthUnit;
        info_.timeName = right.timeName;
        info_.timeUnit = right.timeUnit;
        info_.times = {minus_.source->info().times[std::size_t(minus_.time)]};
        Parameter& parameter = info_.parameters.emplace_back();
        parameter.name = "difference";
        parameter.unit = a.unit;
        parameter.ranges = {scan(progress)};
    }
    const DatasetInfo& info() const override { return info_; }
    const BrickGrid& grid() const override { return minus_.source->grid(); }
    BrickStats stats(const BrickKey& key) const override {
        BrickKey fine = key;
        fine.level = 0;
        return statsOfSamples(read(fine));
    }
    BrickSamples read(const BrickKey& key) const override {
        BrickSamples out = onto_.read(*of_.source, {ofChannel_, of_.time, key.level, key.index});
        const BrickSamples other = minus_.source->read({minusChannel_, minus_.time, key.level, key.index});
        for (std::size_t i = 0; i < out.values.size(); ++i) {
            const bool there = out.isPresent(i) && other.isPresent(i);
            out.values[i] = there ? float(out.exact(i) - toUnit_(other.exact(i))) : 0;
            if (!out.rest.empty()) out.rest[i] = 0;
            if (there) continue;
            if (out.present.empty()) out.present.assign(out.values.size(), 1);
            out.present[i] = 0;
        }
        return out;
    }

private:
    Range scan(const Progress& progress) const {
        const int level = grid().levelWithin(kOtherRangeSamples);
        Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
        const std::size_t bricks = grid().brickCount();
        for (std::size_t n = 0; n < bricks; ++n) {
            progress.advance(double(n) / double(bricks));
            const BrickStats stats = statsOfSamples(read({0, 0, level, grid().indexOf(n)}));
            range.lo = std::min(range.lo, double(stats.min));
            range.hi = std::max(range.hi, double(stats.max));
        }
        return range.lo <= range.hi ? range : Range{0, 0};
    }

    SampledOnto onto_;
    SourceAtTime of_, minus_;
    int ofChannel_, minusChannel_;
    UnitConversion toUnit_; ///< of the subtracted values
    DatasetInfo info_;
};

} // namespace

std::shared_ptr<const BrickSource> withOther(std::shared_ptr<const BrickSource> source,
                                             std::shared_ptr<const BrickSource> other) {
    return std::make_shared<const WithOther>(std::move(source), std::move(other));
}

std::shared_ptr<const BrickSource> otherOf(const BrickSource& source) {
    const auto* with = dynamic_cast<const WithOther*>(&source);
    return with ? with->other() : nullptr;
}

std::shared_ptr<const BrickSource> firstDataOf(const BrickSource& source) {
    const auto* with = dynamic_cast<const WithOther*>(&source);
    return with ? with->own() : nullptr;
}

bool samePlaces(const BrickSource& source, const BrickSource& other) {
    BrickGrid a = other.grid();
    a.brickSize = source.grid().brickSize, a.levels = source.grid().levels, a.phase = source.grid().phase;
    return sameSamples(a, source.grid(), lengthScale(source.info(), other.info()));
}

std::string otherText(const BrickSource& source, const BrickSource& other) {
    std::string text =
        samePlaces(source, other) ? "on the same grid" : "interpolated onto the grid of " + source.info().name;
    const bool single = source.info().parameters.size() == 1 && other.info().parameters.size() == 1;
    for (const Parameter& own : source.info().parameters) {
        const auto same = std::ranges::find_if(other.info().parameters, [&](const Parameter& candidate) {
            return (single || candidate.name == own.name) && candidate.components == own.components;
        });
        if (same != other.info().parameters.end() && same->unit != own.unit && unitConversion(same->unit, own.unit))
            text += ", " + own.name + " from " + same->unit + " to " + (own.unit.empty() ? "1" : own.unit);
    }
    const std::string &own = source.info().lengthUnit, &others = other.info().lengthUnit;
    if (own.empty() != others.empty())
        text += (others.empty() ? ", its lengths" : ", lengths of " + source.info().name) + " taken in " + own +
                others + ", as its file states no unit of length";
    if (const std::string& unit = source.info().timeUnit, &ofOther = other.info().timeUnit;
        unit.empty() != ofOther.empty() && source.info().times.size() > 1 && other.info().times.size() > 1)
        text += (ofOther.empty() ? ", its times" : ", times of " + source.info().name) + " taken in " + unit + ofOther +
                ", as its file states no unit of time";
    return text;
}

std::optional<int> otherChannel(const DatasetInfo& info, int channel) {
    const std::vector<Channel> channels = info.channels();
    const Channel& wanted = channels[std::size_t(channel)];
    const Parameter& parameter = info.parameters[std::size_t(wanted.parameter)];
    for (std::size_t i = 0; i < channels.size(); ++i) {
        const Parameter& own = info.parameters[std::size_t(channels[i].parameter)];
        if (own.name == parameter.name + std::string(kOtherSuffix) && own.components == parameter.components &&
            channels[i].component == wanted.component)
            return int(i);
    }
    return std::nullopt;
}

std::optional<UnitConversion> otherConversion(const DatasetInfo& info, int channel) {
    const std::optional<int> other = otherChannel(info, channel);
    if (!other) return std::nullopt;
    const std::vector<Channel> channels = info.channels();
    return unitConversion(channels[std::size_t(*other)].unit, channels[std::size_t(channel)].unit);
}

std::shared_ptr<const BrickSource> differenceSource(const FieldAt& of, const FieldAt& minus, const Progress& progress) {
    return std::make_shared<const Difference>(of, minus, progress);
}

} // namespace tessera::volume
