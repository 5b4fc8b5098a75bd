#include "codec/bands/rans_model.h"

#include "codec/bytes/bits.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace tessera::codec {

namespace {

using Counts = std::array<std::uint32_t, kTokens>;
using KindTables = std::array<std::uint8_t, kClasses>;

constexpr std::uint32_t kByBand = 128, kFitted = 64; // bits in the byte of the shift

// Cost of a table in the file in bits: its entry in the map, plus a cost per used token.
constexpr double kTableBits = 24, kTokenBits = 8;

/// n log2 n, tabulated for small n.
double nLogN(std::uint32_t n) {
    static const std::array<double, 2048> kSmall = [] {
        std::array<double, 2048> all{};
        for (std::size_t i = 1; i < all.size(); ++i) all[i] = double(i) * std::log2(double(i));
        return all;
    }();
    return n < kSmall.size() ? kSmall[n] : double(n) * std::log2(double(n));
}

/// Bits of the tokens of one context coded with their own optimal table, plus those of the table.
double costOf(std::span<const std::uint32_t> counts) {
    double total = 0, own = 0, used = 0;
    for (const std::uint32_t count : counts) {
        if (count == 0) continue;
        total += count, own += nLogN(count), used += 1;
    }
    return total == 0 ? 0 : total * std::log2(total) - own + kTableBits + used * kTokenBits;
}

/// Scales counts to a sum of kProbabilityOne, with at least 1 for every token that occurs and for the escape.
Frequencies normalised(const Counts& counts) {
    Frequencies out{};
    Counts wanted = counts;
    wanted[kEscape] = std::max<std::uint32_t>(wanted[kEscape], 1);
    if (std::accumulate(wanted.begin(), wanted.end() - 1, 0u) == 0) wanted[0] = 1;
    const double total = std::accumulate(wanted.begin(), wanted.end(), 0.0);
    int sum = 0;
    for (int t = 0; t < kTokens; ++t) {
        const auto at = static_cast<std::size_t>(t);
        if (wanted[at] == 0) continue;
        const double share = wanted[at] / total * kProbabilityOne;
        out[at] = static_cast<std::uint16_t>(std::max(1.0, std::floor(share + 0.5)));
        sum += out[at];
    }
    // Distribute the remainder where it costs least or gains most per step.
    const int step = sum < int(kProbabilityOne) ? 1 : -1;
    const auto gainOf = [&](std::size_t t) {
        if (out[t] == 0 || (step < 0 && out[t] == 1)) return -1e300;
        return wanted[t] * (std::log2(double(out[t] + step)) - std::log2(double(out[t])));
    };
    std::array<double, kTokens> gains;
    for (std::size_t t = 0; t < kTokens && sum != int(kProbabilityOne); ++t) gains[t] = gainOf(t);
    for (; sum != int(kProbabilityOne); sum += step) {
        const auto t = static_cast<std::size_t>(std::max_element(gains.begin(), gains.end()) - gains.begin());
        out[t] = static_cast<std::uint16_t>(out[t] + step);
        gains[t] = gainOf(t);
    }
    return out;
}

constexpr std::uint8_t kNoTable = 255; ///< of a context without tokens, until it gets one

/// Contexts without tokens take the table of the class below, which costs no bits in the map.
void mapEmptyContexts(Model& model) {
    std::uint8_t last = 0;
    for (std::size_t c = 0; c < model.tableOf.size(); ++c) {
        std::uint8_t& table = model.tableOf[c];
        const auto kind = model.tableOf.begin() + std::ptrdiff_t(c);
        if (model.contexts.byBand && c % kClasses == 0 && std::count(kind, kind + kClasses, kNoTable) == kClasses) {
            // A kind of band without tokens takes the tables of the previous kind.
            if (c == 0)
                std::fill_n(kind, kClasses, std::uint8_t(0));
            else
                std::copy_n(kind - kClasses, kClasses, kind);
            c += kClasses - 1;
            continue;
        }
        if (table == kNoTable) table = last;
        last = table;
    }
}

Model clustered(const Histogram& histogram, int mostTables) {
    struct Group {
        Counts counts{};
        std::size_t used = 0; ///< no token from here on occurs
        std::vector<std::size_t> contexts;
        double mean = 0, cost = 0;
    };
    const auto costOfFirst = [](const Counts& counts, std::size_t used) {
        return costOf(std::span(counts).first(used));
    };
    std::vector<Group> all;
    for (std::size_t c = 0; c < histogram.counts.size(); ++c) {
        const Counts& counts = histogram.counts[c];
        std::size_t used = kTokens;
        while (used > 0 && counts[used - 1] == 0) --used;
        double total = 0, sum = 0;
        for (std::size_t t = 0; t < used; ++t) {
            total += counts[t];
            sum += double(counts[t]) * double(t);
        }
        if (total > 0) all.push_back({counts, used, {c}, sum / total, costOfFirst(counts, used)});
    }
    // Similar contexts have similar means, so only neighbours in the order of means are merged.
    std::vector<Group*> groups;
    for (Group& group : all) groups.push_back(&group);
    std::sort(groups.begin(), groups.end(), [](const Group* a, const Group* b) { return a->mean < b->mean; });
    const auto join = [](const Group& a, const Group& b, Counts& counts) {
        const std::size_t used = std::max(a.used, b.used);
        for (std::size_t t = 0; t < used; ++t) counts[t] = a.counts[t] + b.counts[t];
        return used;
    };
    std::vector<double> loss(groups.empty() ? 0 : groups.size() - 1);
    const auto weigh = [&](std::size_t i) {
        Counts both;
        const std::size_t used = join(*groups[i], *groups[i + 1], both);
        loss[i] = costOfFirst(both, used) - groups[i]->cost - groups[i + 1]->cost;
    };
    for (std::size_t i = 0; i + 1 < groups.size(); ++i) weigh(i);
    while (groups.size() > 1) {
        const auto best = std::min_element(loss.begin(), loss.end());
        if (*best >= 0 && int(groups.size()) <= mostTables) break;
        const auto i = static_cast<std::size_t>(best - loss.begin());
        Group &one = *groups[i], &other = *groups[i + 1];
        one.used = join(one, other, one.counts);
        one.cost = costOfFirst(one.counts, one.used);
        one.contexts.insert(one.contexts.end(), other.contexts.begin(), other.contexts.end());
        groups.erase(groups.begin() + std::ptrdiff_t(i) + 1);
        loss.erase(best);
        if (i > 0) weigh(i - 1);
        if (i + 1 < groups.size()) weigh(i);
    }

    Model model;
    model.levels = histogram.levels;
    model.contexts = histogram.contexts;
    model.tableOf.assign(histogram.counts.size(), kNoTable);
    for (std::size_t g = 0; g < groups.size(); ++g) {
        model.tables.push_back(normalised(groups[g]->counts));
        for (const std::size_t c : groups[g]->contexts) model.tableOf[c] = static_cast<std::uint8_t>(g);
    }
    if (model.tables.empty()) model.tables.push_back(normalised(Counts{}));
    mapEmptyContexts(model);
    return model;
}

/// The histogram with all kinds of bands of a level merged.
Histogram pooled(const Histogram& histogram) {
    Histogram pool(histogram.levels, {histogram.contexts.shift, false});
    for (int level = 0; level < histogram.levels; ++level)
        for (int kind = 0; kind < histogram.contexts.kindsOf(level); ++kind)
            for (std::size_t c = 0; c < kClasses; ++c)
                for (std::size_t t = 0; t < kTokens; ++t)
                    pool.counts[pool.contexts.first(level) + c][t] +=
                        histogram.counts[histogram.contexts.first(level, kind) + c][t];
    return pool;
}

/// Expands a model of a merged histogram to contexts by band: all kinds of a level use the same tables.
Model spread(const Model& pool, Contexts contexts) {
    Model model{pool.levels, contexts, {}, pool.tables};
    for (int level = 0; level < pool.levels; ++level)
        for (int kind = 0; kind < contexts.kindsOf(level); ++kind) {
            const auto from = pool.tableOf.begin() + std::ptrdiff_t(pool.contexts.first(level));
            model.tableOf.insert(model.tableOf.end(), from, from + kClasses);
        }
    return model;
}

} // namespace

double Histogram::bits() const {
    double sum = 0;
    for (const Counts& context : counts) {
        double total = 0;
        for (const std::uint32_t count : context) total += count;
        for (std::size_t t = 0; t < kTokens; ++t)
            if (context[t] > 0)
                sum += context[t] * (std::log2(total / context[t]) + rawBitsOf(static_cast<std::uint32_t>(t)));
    }
    return sum;
}

void Histogram::add(const Histogram& other) {
    for (std::size_t c = 0; c < counts.size(); ++c)
        for (std::size_t t = 0; t < kTokens; ++t) counts[c][t] += other.counts[c][t];
}

Model makeModel(const Histogram& histogram, int mostTables) {
    Model model = clustered(histogram, mostTables);
    if (!histogram.contexts.byBand) return model;
    // For few samples, separate tables per kind cost more bytes than they save.
    constexpr double kFew = 1 << 20;
    double count = 0;
    for (const Counts& context : histogram.counts) count += std::accumulate(context.begin(), context.end(), 0.0);
    if (count > kFew) return model;
    Model shared = spread(clustered(pooled(histogram), mostTables), histogram.contexts);
    const auto cost = [&](const Model& of) { return bitsWith(of, histogram) + 8.0 * double(serialise(of).size()); };
    return cost(shared) < cost(model) ? shared : model;
}

double bitsWith(const Model& model, const Histogram& histogram) {
    double sum = 0;
    for (std::size_t c = 0; c < histogram.counts.size(); ++c) {
        const Frequencies& table = model.tables[model.tableOf[c]];
        for (std::size_t t = 0; t < kTokens; ++t) {
            const std::uint32_t count = histogram.counts[c][t];
            if (count == 0) continue;
            const auto raw = static_cast<double>(rawBitsOf(static_cast<std::uint32_t>(t)));
            sum += table[t] > 0 ? count * (kProbabilityBits - std::log2(double(table[t])) + raw)
                                : count * (kProbabilityBits - std::log2(double(table[kEscape])) + 32);
        }
    }
    return sum;
}

Bytes serialise(const Model& model) {
    BitWriter out;
    out.put(static_cast<std::uint32_t>(model.contexts.shift) | (model.contexts.byBand ? kByBand : 0) |
                (model.fitted.empty() ? 0 : kFitted),
            8);
    out.put(static_cast<std::uint32_t>(model.tables.size()), 8);
    std::uint32_t last = 0;
    KindTables before{};
    for (auto at = model.tableOf.begin(); at != model.tableOf.end(); at += kClasses) {
        if (model.contexts.byBand) { // 0: as the previous kind
            const bool other = !std::equal(before.begin(), before.end(), at);
            out.put(other ? 1 : 0, 1);
            if (!other) continue;
            std::copy_n(at, kClasses, before.begin());
        }
        for (auto table = at; table != at + kClasses; last = *table++) { // 0: as the previous class
            out.put(*table == last ? 0 : 1, 1);
            if (*table != last) out.put(*table, 8);
        }
    }
    for (const Frequencies& table : model.tables) {
        int used = kTokens - 1; // the escape has the remainder
        while (used > 0 && table[std::size_t(used - 1)] == 0) --used;
        out.put(static_cast<std::uint32_t>(used), 8);
        for (int t = 0; t < used; ++t) {
            const std::uint32_t frequency = table[std::size_t(t)];
            const int width = std::bit_width(frequency);
            out.put(static_cast<std::uint32_t>(width), 4);
            if (width > 1) out.put(frequency & ((1u << (width - 1)) - 1), width - 1);
        }
    }
    if (!model.fitted.empty()) write(model.fitted, out);
    return out.bytes;
}

DecodeStatus parseModel(std::span<const std::byte> bytes, int levels, Model& model) {
    if (bytes.empty()) {
        model = makeModel(Histogram(levels, {}), 1);
        return DecodeStatus::Ok;
    }
    BitReader in(bytes);
    model = {};
    model.levels = levels;
    const std::uint32_t how = in.get(8), tables = in.get(8);
    if (in.failed) return DecodeStatus::Truncated;
    model.contexts = {static_cast<int>(how & ~(kByBand | kFitted)), (how & kByBand) != 0};
    if (tables == 0 || model.contexts.shift > 31) return DecodeStatus::BadLength;
    std::uint32_t last = 0;
    KindTables before{};
    for (std::size_t first = 0; first < model.contexts.first(levels); first += kClasses) {
        const bool other = !model.contexts.byBand || in.get(1) != 0;
        for (std::size_t c = 0; other && c < kClasses; ++c) {
            if (in.get(1) != 0) last = in.get(8);
            if (in.failed) return DecodeStatus::Truncated;
            if (last >= tables) return DecodeStatus::BadLength;
            before[c] = static_cast<std::uint8_t>(last);
        }
        model.tableOf.insert(model.tableOf.end(), before.begin(), before.end());
    }
    if (in.failed) return DecodeStatus::Truncated;
    for (std::uint32_t i = 0; i < tables; ++i) {
        const std::uint32_t used = in.get(8);
        if (used >= kTokens) return DecodeStatus::BadLength;
        Frequencies& table = model.tables.emplace_back();
        std::uint32_t sum = 0;
        for (std::uint32_t t = 0; t < used; ++t) {
            const auto width = static_cast<int>(in.get(4));
            const std::uint32_t frequency = width == 0 ? 0 : (1u << (width - 1)) | in.get(width - 1);
            if (in.failed) return DecodeStatus::Truncated;
            sum += frequency;
            if (sum >= kProbabilityOne) return DecodeStatus::BadData;
            table[t] = static_cast<std::uint16_t>(frequency);
        }
        if (in.failed) return DecodeStatus::Truncated;
        if (sum == 0) return DecodeStatus::BadData; // at least two tokens, since a frequency has only twelve bits
        table[kEscape] = static_cast<std::uint16_t>(kProbabilityOne - sum);
    }
    if ((how & kFitted) != 0) {
        if (!read(in, model.fitted)) return in.failed ? DecodeStatus::Truncated : DecodeStatus::BadData;
        if (model.fitted.empty()) return DecodeStatus::BadData;
    }
    return in.bytesRead() == bytes.size() ? DecodeStatus::Ok : DecodeStatus::Trailing;
}

std::vector<std::uint32_t> decodeTable(const Model& model) {
    std::vector<std::uint32_t> out(model.tables.size() * kProbabilityOne);
    auto to = out.begin();
    for (const Frequencies& table : model.tables)
        for (std::uint32_t t = 0; t < kTokens; ++t)
            for (std::uint32_t slot = 0; slot < table[t]; ++slot)
                *to++ = t | static_cast<std::uint32_t>(table[t]) << 8 | slot << 20;
    return out;
}

} // namespace tessera::codec
