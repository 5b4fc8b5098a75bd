#include "codec/container/coded_numbers.h"

#include "codec/bytes/lzma.h"
#include "codec/container/container.h"
#include "codec/container/json_text.h"
#include "codec/container/number_shape.h"
#include "volume/flow/whole_numbers.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

namespace tessera::codec {

namespace {

using nlohmann::json;
using volume::ComputedNumbers;
using volume::LabelNumbers;
using volume::NumbersAtTime;
using volume::Summary;

constexpr int kMostOrder = 3;
constexpr std::uint64_t kRounding = 12; ///< low bits of 52 that are given up: 2^-41 of a number

/// Numbers without samples are not numbers, and coded as 0.
template <class Change> void changeEmpty(LabelNumbers& numbers, const Change& change) {
    const auto each = [&](std::vector<Summary>& summaries) {
        for (Summary& of : summaries)
            if (!(of.samples > 0)) change(of);
    };
    each(numbers.statistics.all);
    for (std::vector<Summary>& summaries : numbers.statistics.summary) each(summaries);
}

/// Doubles as integers in the same order; neighbouring ones differ by 1.
std::int64_t ordered(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    const auto magnitude = static_cast<std::int64_t>(bits & (~std::uint64_t(0) >> 1));
    return (bits >> 63) != 0 ? -magnitude : magnitude;
}
double unordered(std::int64_t number) {
    const auto bits = static_cast<std::uint64_t>(number);
    return std::bit_cast<double>(number < 0 ? (0 - bits) | (std::uint64_t(1) << 63) : bits);
}

double roundedNumber(double value) {
    if (!std::isfinite(value)) return value;
    constexpr std::int64_t kUnit = std::int64_t(1) << kRounding;
    const std::int64_t number = ordered(value);
    return unordered((number + (number < 0 ? -kUnit / 2 : kUnit / 2)) / kUnit * kUnit);
}

/// What is added to the prediction of order 1, 2 or 3 of integer t from those before it, in arithmetic modulo 2^64.
std::uint64_t foreseen(std::span<const std::uint64_t> before, int order) {
    const std::size_t n = before.size();
    if (order == 1 || n < 2) return before[n - 1];
    if (order == 2 || n < 3) return 2 * before[n - 1] - before[n - 2];
    return 3 * before[n - 1] - 3 * before[n - 2] + before[n - 3];
}

std::uint64_t zigzagged(std::uint64_t difference) {
    return (difference << 1) ^ (0 - (difference >> 63));
}
std::uint64_t unzigzagged(std::uint64_t symbol) {
    return (symbol >> 1) ^ (0 - (symbol & 1));
}

/// Appends the values of one number over the times.
void putSeries(ByteWriter& out, std::span<const double> values) {
    const auto same = [&](double value) {
        return std::bit_cast<std::uint64_t>(value) == std::bit_cast<std::uint64_t>(values[0]);
    };
    if (std::ranges::all_of(values, same)) {
        const bool zero = std::bit_cast<std::uint64_t>(values[0]) == 0;
        out.put(std::uint8_t(zero ? 0 : 1));
        if (!zero) out.put(values[0]);
        return;
    }
    std::uint64_t any = 0;
    for (const double value : values) any |= static_cast<std::uint64_t>(ordered(value));
    const int shift = any == 0 ? 0 : std::countr_zero(any); // 0: zeros of both signs
    std::vector<std::uint64_t> numbers;
    for (const double value : values) numbers.push_back(static_cast<std::uint64_t>(ordered(value) >> shift));
    std::vector<std::uint64_t> best;
    int bestOrder = 0;
    double least = std::numeric_limits<double>::infinity();
    for (int order = 1; order <= kMostOrder; ++order) {
        std::vector<std::uint64_t> symbols;
        double bits = 0;
        for (std::size_t t = 1; t < numbers.size(); ++t) {
            symbols.push_back(zigzagged(numbers[t] - foreseen(std::span(numbers).first(t), order)));
            bits += double(std::bit_width(symbols.back()));
        }
        if (bits < least) least = bits, best = std::move(symbols), bestOrder = order;
    }
    const std::size_t planes = (std::size_t(std::bit_width(std::ranges::max(best))) + 7) / 8;
    out.put(std::uint8_t(1 + bestOrder));
    out.put(std::uint8_t(shift));
    out.put(std::uint8_t(planes));
    out.put(values[0]);
    for (std::size_t plane = planes; plane-- > 0;)
        for (const std::uint64_t symbol : best) out.put(static_cast<std::uint8_t>(symbol >> (8 * plane)));
}

void takeSeries(ByteReader& in, std::span<double> values) {
    needNumbers(in.left() >= 1, "they are truncated");
    const int mode = in.get<std::uint8_t>();
    needNumbers(mode <= 1 + kMostOrder, "a series is of an unknown kind");
    if (mode <= 1) {
        needNumbers(mode == 0 || in.left() >= 8, "they are truncated");
        std::ranges::fill(values, mode == 0 ? 0 : in.get<double>());
        return;
    }
    needNumbers(in.left() >= 10, "they are truncated");
    const int shift = in.get<std::uint8_t>();
    const std::size_t planes = in.get<std::uint8_t>();
    needNumbers(shift < 64 && planes <= 8, "a series is of an unknown kind");
    std::vector<std::uint64_t> numbers{static_cast<std::uint64_t>(ordered(in.get<double>()) >> shift)};
    std::vector<std::uint64_t> symbols(values.size() - 1, 0);
    needNumbers(in.left() >= planes * symbols.size(), "they are truncated");
    for (std::size_t plane = planes; plane-- > 0;)
        for (std::uint64_t& symbol : symbols) symbol |= std::uint64_t(in.get<std::uint8_t>()) << (8 * plane);
    for (const std::uint64_t symbol : symbols) numbers.push_back(foreseen(numbers, mode - 1) + unzigzagged(symbol));
    for (std::size_t t = 0; t < values.size(); ++t)
        values[t] = unordered(static_cast<std::int64_t>(numbers[t] << shift));
}

/// Sets the numbers of everything that follow from those of regions.
void deriveWhole(NumbersAtTime& time) {
    LabelNumbers& whole = time.labels[0];
    const LabelNumbers& regions = time.labels[1];
    for (std::size_t c = 0; c < whole.channels.size(); ++c)
        whole.statistics.all[c] =
            volume::wholeSummary(regions.statistics, c, whole.statistics.all[c], regions.byVolume);
    for (std::size_t k = 0; k < whole.carried.size(); ++k)
        whole.balances[k] = {volume::wholeBalance(regions.balances[k])};
}

/// How many numbers of all times together a block of so many bytes may hold.
std::uint64_t mostNumbers(std::uint64_t bytes) {
    return (std::uint64_t(1) << 20) + 2 * bytes;
}

/// The block of times with the same labels, channels and velocity, in its order; empty if that would be longer than
/// LZMA allows or hold too many numbers, and they can be divided.
Bytes blockOf(std::span<const NumbersAtTime> times, std::string& shape) {
    std::vector<std::vector<double>> values; // [number][time]
    json labels = json::array();
    for (std::size_t place = 0; place < times.front().labels.size(); ++place) {
        const NumberShape own = shapeOf(times, place);
        labels.push_back(toJson(own));
        const std::size_t first = values.size();
        for (const NumbersAtTime& time : times) {
            LabelNumbers numbers = widened(time.labels[place], own);
            changeEmpty(numbers, [](Summary& of) { of = {}; });
            std::size_t at = first;
            visitNumbers(numbers, place == 0, own.derived, [&](double value, bool exact) {
                if (at == values.size()) values.emplace_back();
                values[at++].push_back(exact ? value : roundedNumber(value));
            });
        }
    }
    const std::string text = jsonText({{"labels", std::move(labels)}});
    ByteWriter content;
    const std::string& said = text == shape ? std::string() : text;
    content.put(static_cast<std::uint32_t>(said.size()));
    for (const char c : said) content.put(static_cast<std::uint8_t>(c));
    content.put(static_cast<std::uint32_t>(times.size()));
    for (const NumbersAtTime& time : times) content.put(time.time);
    for (const std::vector<double>& series : values) putSeries(content, series);
    const bool fits =
        content.bytes.size() <= kLongBlock && values.size() * times.size() <= mostNumbers(content.bytes.size());
    if (!fits && times.size() > 1) return {};
    shape = text;
    const Bytes coded = encodeBlock(content.bytes);
    ByteWriter out;
    out.put(checksum(coded));
    out.bytes.insert(out.bytes.end(), coded.begin(), coded.end());
    return std::move(out.bytes);
}

void addBlocks(std::span<const NumbersAtTime> times, std::string& shape, std::vector<Bytes>& blocks) {
    Bytes block = blockOf(times, shape);
    if (!block.empty()) return blocks.push_back(std::move(block));
    addBlocks(times.first(times.size() / 2), shape, blocks);
    addBlocks(times.subspan(times.size() / 2), shape, blocks);
}

bool alike(const NumbersAtTime& a, const NumbersAtTime& b) {
    return std::ranges::equal(a.labels, b.labels, [](const LabelNumbers& own, const LabelNumbers& other) {
        return own.label == other.label && own.velocity == other.velocity && own.channels == other.channels &&
               own.carried == other.carried && own.byVolume == other.byVolume;
    });
}

/// Numbers that were made together, each set with those of everything before those of labels.
std::vector<ComputedNumbers> setsOf(const ComputedNumbers& numbers) {
    std::vector<ComputedNumbers> sets;
    for (const NumbersAtTime& time : numbers) {
        std::size_t set = 0;
        for (const LabelNumbers& of : time.labels) {
            if (of.label.empty()) ++set;
            if (set > sets.size()) sets.emplace_back();
            ComputedNumbers& own = sets[set - 1];
            if (own.empty() || own.back().time != time.time) own.push_back({time.time, {}});
            own.back().labels.push_back(of);
        }
    }
    return sets;
}

} // namespace

std::vector<Bytes> encodeNumbers(const ComputedNumbers& numbers, std::string& shape) {
    std::vector<Bytes> blocks;
    for (const ComputedNumbers& set : setsOf(numbers))
        for (auto begin = set.begin(); begin != set.end();) {
            const auto end =
                std::find_if_not(begin, set.end(), [&](const NumbersAtTime& time) { return alike(*begin, time); });
            addBlocks({begin, end}, shape, blocks);
            begin = end;
        }
    return blocks;
}

void addNumbers(ComputedNumbers more, ComputedNumbers& numbers) {
    for (NumbersAtTime& time : more) {
        const auto at = std::ranges::lower_bound(numbers, time.time, {}, &NumbersAtTime::time);
        if (at == numbers.end() || at->time != time.time)
            numbers.insert(at, std::move(time));
        else
            std::ranges::move(time.labels, std::back_inserter(at->labels));
    }
}

ComputedNumbers decodeNumbers(std::span<const std::byte> block, std::string& shape) {
    needNumbers(block.size() > 8, "they are truncated");
    const auto body = block.subspan(8);
    needNumbers(ByteReader(block).get<std::uint64_t>() == checksum(body), "their checksum is wrong");
    Bytes content;
    needNumbers(decodeBlock(body, content) == DecodeStatus::Ok, "they cannot be decoded");
    ByteReader in(content);
    needNumbers(in.left() >= 4, "they are truncated");
    const std::size_t length = in.get<std::uint32_t>();
    needNumbers(in.left() >= length + 4, "they are truncated");
    if (length > 0) shape.assign(reinterpret_cast<const char*>(in.rest().data()), length);
    in = ByteReader(in.rest().subspan(length));
    const std::vector<NumberShape> shapes = shapesOf(shape);
    const std::size_t times = in.get<std::uint32_t>();
    needNumbers(times > 0 && in.left() / 8 >= times, "they are truncated");
    std::vector<double> all(times);
    for (double& time : all) time = in.get<double>();
    needNumbers(std::isfinite(all.front()) && std::isfinite(all.back()) &&
                    std::ranges::is_sorted(all, std::less_equal<>()),
                "times are out of order");
    // Each number takes a byte at least, whatever the texts promise.
    const auto size = [](const NumberShape& of) {
        const double summaries = double(of.regions.size()) + 1;
        return summaries * (2 + 6 * double(of.channels.size())) +
               double(of.carried.size()) * (34 * summaries + 4 * double(of.borders.size()));
    };
    double numbers = 0;
    for (const NumberShape& of : shapes) numbers += size(of);
    needNumbers(numbers < 2 * double(in.left()) + 1e5 &&
                    numbers * double(times) <= 2 * double(mostNumbers(content.size())),
                "they are too many");
    ComputedNumbers out(times);
    for (std::size_t t = 0; t < times; ++t) {
        out[t].time = all[t];
        for (const NumberShape& of : shapes) out[t].labels.push_back(emptyNumbers(of));
    }
    std::vector<double> series(times);
    for (std::size_t place = 0; place < shapes.size(); ++place) {
        std::vector<std::vector<double*>> at(times);
        for (std::size_t t = 0; t < times; ++t)
            visitNumbers(out[t].labels[place], place == 0, shapes[place].derived,
                         [&](double& value, bool) { at[t].push_back(&value); });
        for (std::size_t n = 0; n < at.front().size(); ++n) {
            takeSeries(in, series);
            for (std::size_t t = 0; t < times; ++t) *at[t][n] = series[t];
        }
    }
    needNumbers(in.left() == 0, "there are more of them than they are of");
    for (NumbersAtTime& time : out) {
        if (shapes.front().derived) deriveWhole(time);
        for (LabelNumbers& of : time.labels) {
            const volume::RegionStatistics& whole = time.labels.front().statistics;
            of.statistics.allSamples = whole.allSamples;
            of.statistics.allVolume = whole.allVolume;
            of.statistics.all = whole.all;
            constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
            changeEmpty(of, [&](Summary& none) { none = {0, 0, kNone, kNone, kNone, kNone, 0}; });
            narrow(of);
        }
    }
    return out;
}

} // namespace tessera::codec
