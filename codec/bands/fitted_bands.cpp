#include "codec/bands/fitted_bands.h"

#include <cassert>
#include <utility>

namespace tessera::codec {

namespace {

constexpr int kWidest = 512; // samples along an edge of merged bricks

/// The bits of a pass's band: the axes along which its samples lie between those known.
int kindOf(Pass pass) {
    return pass == Pass::AlongZ ? 4 : pass == Pass::AlongY ? 2 : pass == Pass::AlongX ? 1 : 0;
}

int turnOf(Pass pass) {
    return static_cast<int>(pass);
}

/// The passes of a level that have samples, in order.
template <class Word>
std::vector<PassRows<Word>> passesOf(glm::ivec3 size, bool hasOther, const FittedMemory<Word>& memory) {
    std::vector<PassRows<Word>> passes;
    if (size.z > 1) passes.emplace_back(Pass::AlongZ, size, memory.even, memory.even);
    if (size.y > 1) passes.emplace_back(Pass::AlongY, size, memory.even, memory.even);
    if (size.x > 1) passes.emplace_back(Pass::AlongX, size, memory.even, memory.odd);
    if (hasOther) passes.emplace_back(Pass::Odd, memory.other.size(), memory.sublattice, memory.other);
    return passes;
}

template <class Word> void padAll(PaddedBox<Word>& box) {
    for (int z = 0; box.size().x > 0 && z < box.size().z; ++z)
        for (int y = 0; y < box.size().y; ++y) box.pad(z, y);
}

/// The box of a pass's own samples.
template <class Word> PaddedBox<Word>& boxOf(Pass pass, FittedMemory<Word>& memory) {
    return pass == Pass::AlongX ? memory.odd : pass == Pass::Odd ? memory.other : memory.even;
}

template <class Word> bool isEmpty(const Box<Word>& box) {
    return box.size.x < 1 || box.size.y < 1 || box.size.z < 1;
}

template <class Word> void resetColumns(glm::ivec3 size, FittedMemory<Word>& memory) {
    const int widest = (size.x + 1) / 2;
    memory.even.reset({widest, size.y, size.z}, widest);
    memory.odd.reset({size.x / 2, size.y, size.z}, widest);
}

/// Distributes the samples of a level, which lie 2^level apart, over the boxes of the passes.
template <class Word> glm::ivec3 place(const FittedLevel<Word>& of, FittedMemory<Word>& memory) {
    const int stride = 1 << of.level;
    const glm::ivec3 size = (of.samples.size + stride - 1) / stride;
    resetColumns(size, memory);
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y) {
            const Word* const from = of.samples.row(y * stride, z * stride);
            Word *const even = memory.even.row(z, y), *const odd = memory.odd.row(z, y);
            for (int x = 0; x < memory.even.size().x; ++x) even[x] = from[2 * x * stride];
            for (int x = 0; x < memory.odd.size().x; ++x) odd[x] = from[(2 * x + 1) * stride];
        }
    padAll(memory.even);
    padAll(memory.odd);
    memory.other.reset(glm::ivec3(0), 0);
    if (isEmpty(of.other)) return size;
    assert(of.level == 0);
    const auto copy = [](const Box<const Word>& from, PaddedBox<Word>& to) {
        to.reset(from.size, from.size.x);
        for (int z = 0; z < from.size.z; ++z)
            for (int y = 0; y < from.size.y; ++y) std::copy_n(from.row(y, z), from.size.x, to.row(z, y));
        padAll(to);
    };
    copy(of.samples, memory.sublattice);
    copy(of.other, memory.other);
    return size;
}

/// The predictions of a row and their activity.
template <class Word> struct Prediction {
    std::array<Word, kWidest> values;
    std::array<std::uint16_t, kWidest + kPredictedBlock> activity{};
};

/// How the rows of a level are predicted.
struct Predicting {
    int level = 0, shift = 0;
    const FittedWeights& weights;
    CodeRange range;

    template <class Word> void predict(PassRows<Word>& rows, int z, int y, Prediction<Word>& out) const {
        predictRow<Word>(rows.pass(), rows.taps(z, y), weights.at(level, rows.pass()), range, shift, rows.count().x,
                         out.values.data(), out.activity.data());
    }
};

/// Computes differences before rows are coded.
template <class Word> class Subtracting : public RowPredictor<Word> {
public:
    Subtracting(std::vector<PassRows<Word>>& passes, const Predicting& how, FittedMemory<Word>& memory)
        : passes_(passes), how_(how), memory_(memory) {}

    PredictedRow<Word> begin(std::size_t band, int z, int y) override {
        PassRows<Word>& rows = passes_[band];
        how_.predict(rows, z, y, row_);
        const Word* const from = boxOf(rows.pass(), memory_).row(rows.zOf(z), rows.yOf(y));
        Word* const to = memory_.differences[static_cast<std::size_t>(rows.pass())].row(z, y);
        for (int x = 0; x < rows.count().x; ++x) to[x] = static_cast<Word>(from[x] - row_.values[std::size_t(x)]);
        return {row_.activity.data(), nullptr};
    }
    void end(std::size_t, int, int) override {}

private:
    std::vector<PassRows<Word>>& passes_;
    const Predicting& how_;
    FittedMemory<Word>& memory_;
    Prediction<Word> row_;
};

/// Puts the columns of a level together.
template <class Word, class To> void joinColumns(const FittedMemory<Word>& memory, glm::ivec3 size, To&& rowAt) {
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y) {
            const Word *const even = memory.even.row(z, y), *const odd = memory.odd.row(z, y);
            Word* const to = rowAt(z, y);
            for (int x = 0; x < size.x / 2; ++x) to[2 * x] = even[x], to[2 * x + 1] = odd[x];
            if (size.x % 2 != 0) to[size.x - 1] = even[size.x / 2];
        }
}

/// Adds predictions after rows were decoded.
template <class Word> class Adding : public RowPredictor<Word> {
public:
    Adding(std::vector<PassRows<Word>>& passes, glm::ivec3 size, const Predicting& how, FittedMemory<Word>& memory)
        : passes_(passes), size_(size), how_(how), memory_(memory) {}

    PredictedRow<Word> begin(std::size_t band, int z, int y) override {
        PassRows<Word>& rows = passes_[band];
        if (rows.pass() == Pass::Odd && z == 0 && y == 0) {
            joinColumns<Word>(memory_, size_, [&](int atZ, int atY) { return memory_.sublattice.row(atZ, atY); });
            padAll(memory_.sublattice);
        }
        how_.predict(rows, z, y, row_);
        return {row_.activity.data(), row_.values.data()};
    }
    void end(std::size_t band, int z, int y) override {
        const PassRows<Word>& rows = passes_[band];
        boxOf(rows.pass(), memory_).pad(rows.zOf(z), rows.yOf(y));
    }

private:
    std::vector<PassRows<Word>>& passes_;
    glm::ivec3 size_;
    const Predicting& how_;
    FittedMemory<Word>& memory_;
    Prediction<Word> row_;
};

} // namespace

template <class Word>
TokenRun fittedTokens(const FittedLevel<Word>& of, Contexts contexts, const FittedWeights& weights, CodeRange range,
                      FittedMemory<Word>& memory) {
    const glm::ivec3 size = place(of, memory);
    auto passes = passesOf<Word>(size, !isEmpty(of.other), memory);
    std::vector<Band<const Word>> bands;
    for (const PassRows<Word>& rows : passes) {
        PaddedBox<Word>& differences = memory.differences[static_cast<std::size_t>(rows.pass())];
        differences.reset(rows.count(), rows.count().x);
        bands.push_back({differences.row(0, 0), nullptr, rows.count(), differences.pitch(), differences.slice(),
                         kindOf(rows.pass()), turnOf(rows.pass())});
    }
    const Predicting how{of.level, contexts.shift, weights, range};
    Subtracting<Word> predictor(passes, how, memory);
    return tokensOf<Word>(bands, contexts, bestCpu(), &predictor);
}

template <class Word>
void addToFit(const FittedLevel<Word>& of, int shift, int every, FittedMemory<Word>& memory, WeightFit& fit) {
    const glm::ivec3 size = place(of, memory);
    auto passes = passesOf<Word>(size, !isEmpty(of.other), memory);
    int row = 0;
    for (PassRows<Word>& rows : passes)
        for (int z = 0; z < rows.count().z; ++z)
            for (int y = 0; y < rows.count().y; ++y)
                if (row++ % every == 0)
                    fit.add(of.level, rows, z, y, boxOf(rows.pass(), memory).row(rows.zOf(z), rows.yOf(y)), shift);
}

template <class Word>
DecodeStatus decodeFitted(std::span<const std::byte> in, bool nothing, int level, const Box<const Word>& coarse,
                          const Box<Word>& samples, const Box<Word>& other, const BandDecoder& decoder, CodeRange range,
                          FittedMemory<Word>& memory) {
    const glm::ivec3 size = samples.size;
    const Model& model = decoder.model();
    resetColumns(size, memory);
    for (int z = 0; z < coarse.size.z; ++z)
        for (int y = 0; y < coarse.size.y; ++y) {
            std::copy_n(coarse.row(y, z), coarse.size.x, memory.even.row(2 * z, 2 * y));
            memory.even.pad(2 * z, 2 * y);
        }
    const bool hasOther = !isEmpty(other);
    memory.sublattice.reset(hasOther ? size : glm::ivec3(0), size.x);
    memory.other.reset(hasOther ? other.size : glm::ivec3(0), size.x);
    auto passes = passesOf<Word>(size, hasOther, memory);
    std::vector<Band<Word>> bands;
    for (const PassRows<Word>& rows : passes) {
        if (model.fitted.at(level, rows.pass()).empty() || rows.count().x > kWidest) return DecodeStatus::BadData;
        PaddedBox<Word>& box = boxOf(rows.pass(), memory);
        bands.push_back({box.row(rows.zOf(0), rows.yOf(0)), nullptr, rows.count(),
                         box.pitch() * (rows.yOf(1) - rows.yOf(0)), box.slice() * (rows.zOf(1) - rows.zOf(0)),
                         kindOf(rows.pass()), turnOf(rows.pass())});
    }
    const Predicting how{level, model.contexts.shift, model.fitted, range};
    Adding<Word> predictor(passes, size, how, memory);
    if (nothing) {
        if (!in.empty()) return DecodeStatus::Trailing;
        for (std::size_t b = 0; b < bands.size(); ++b)
            for (int z = 0; z < bands[b].size.z; ++z)
                for (int y = 0; y < bands[b].size.y; ++y) {
                    const PredictedRow<Word> row = predictor.begin(b, z, y);
                    std::copy_n(row.values, bands[b].size.x,
                                bands[b].values + z * bands[b].slicePitch + y * bands[b].rowPitch);
                    predictor.end(b, z, y);
                }
    } else if (const DecodeStatus status = decoder.decode<Word>(in, bands, level, bestCpu(), &predictor);
               status != DecodeStatus::Ok) {
        return status;
    }
    joinColumns<Word>(memory, size, [&](int z, int y) { return samples.row(y, z); });
    for (int z = 0; hasOther && z < other.size.z; ++z)
        for (int y = 0; y < other.size.y; ++y) std::copy_n(memory.other.row(z, y), other.size.x, other.row(y, z));
    return DecodeStatus::Ok;
}

// Word is a type, around which no parentheses may stand.
#define TESSERA_FITTED(Word)                                                                                           \
    template TokenRun fittedTokens(const FittedLevel<Word>&, Contexts, const FittedWeights&, CodeRange,                \
                                   FittedMemory<Word>&);                                                               \
    template void addToFit(const FittedLevel<Word>&, int, int, FittedMemory<Word>&, WeightFit&);                       \
    template DecodeStatus decodeFitted(std::span<const std::byte>, bool, int, const Box<const Word>&,                  \
                                       const Box<Word>&, const Box<Word>&, const BandDecoder&, CodeRange,              \
                                       FittedMemory<Word>&);
TESSERA_FITTED(std::int16_t)
TESSERA_FITTED(std::int32_t)
#undef TESSERA_FITTED

} // namespace tessera::codec
