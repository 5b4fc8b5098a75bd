#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

/// A second reader of archives: slow, without any code of the first, following codec/FORMAT.md line by line. It refuses
/// by std::runtime_error.
namespace tessera::codec::plain {

using Size = std::array<int, 3>;

/// One brick at one level, storage order, x fastest.
struct Brick {
    Size size{};
    std::vector<bool> present;
    std::vector<double> values;            ///< physical values, not held within the range; 0 where absent
    std::vector<std::uint32_t> subsamples; ///< of subsampled frames: stored numbers that segment 0 begins with
    std::vector<std::uint32_t> bits; ///< level 0: the stored numbers, sign-extended or bits of a float; kept absent too
};

/// What the index says of the values of a brick.
struct Statistics {
    std::uint64_t samples = 0; ///< present and finite; 0: nothing else is said
    double mean = 0;
    std::vector<std::uint32_t> counts;
};

struct Reader;

class Decoder {
public:
    explicit Decoder(std::vector<char> file);

    const nlohmann::json& metadata() const { return metadata_; }
    /// 1.7
    const std::vector<Decoder>& corrections() const { return corrections_; }
    int levels() const { return levels_; }
    Size bricks() const { return bricks_; }
    std::size_t frames() const { return frames_.size(); }
    /// Frame = (time * components + component); brick numbers x fastest.
    Brick brick(std::size_t frame, int number, int level) const;
    Statistics statistics(std::size_t frame, int number) const;
    /// 4.10: of the brick that is shown, which an earlier frame may hold.
    int depth(std::size_t frame, int number) const;
    /// Where the first segment of a brick lies in the file.
    std::size_t place(std::size_t frame, int number) const;

    struct Model {
        std::uint32_t shift = 0;
        bool byBand = false;
        std::vector<std::vector<std::uint32_t>> tableOf; ///< [8 level + kind] of each class
        std::vector<std::vector<std::uint32_t>> tables;
        /// 4.11: [4 depth + pass], for each class the weights of the taps, then what is added; empty: none.
        std::array<std::vector<std::vector<std::int32_t>>, 12> weights;
        bool fitted = false;
    };

private:
    struct Piece {
        std::size_t offset = 0, length = 0;
        std::uint64_t checksum = 0;
    };
    struct Mask {
        std::vector<Piece> pieces;
        std::vector<std::uint32_t> present;
    };
    struct Frame {
        int numbers = 0, wavelet = 0, mask = -1, codeBits = 32;
        std::size_t model = 0;
        bool keepsAbsent = false, bodyCentred = false, subsampled = false, predicted = false, parted = false;
        double origin = 0, step = 1, valueOffset = 0, valueScale = 1;
        std::vector<std::size_t> repeats; ///< by brick: the frame so many times before holds it
        std::vector<Piece> pieces;        ///< [segment * bricks + brick]
        std::vector<std::array<float, 2>> ranges;
        std::vector<Statistics> statistics;
    };

    static Piece readPiece(Reader& in);
    /// 1.4
    void readPage(const std::vector<std::uint8_t>& page, std::vector<double>& times,
                  std::vector<std::pair<std::size_t, Frame>>& frames, std::vector<Piece>& covered);
    /// 1.6
    void readStatistics(const std::vector<std::uint8_t>& bits, Frame& frame, std::size_t& at) const;
    Model parseModel(const Piece& piece) const;
    std::vector<std::uint8_t> checked(const Piece& piece) const;
    /// 4.13: the part of each sample at full resolution.
    std::vector<std::size_t> partsOf(std::size_t frame, int number) const;
    std::vector<bool> fineFlags(const Frame& frame, int number, const Size& size) const;
    Size fineSize(int number) const;

    std::vector<std::uint8_t> file_;
    nlohmann::json metadata_;
    std::vector<Decoder> corrections_;
    bool bcc_ = false;
    Size size_{}, bricks_{};
    int brickSize_ = 0, levels_ = 0;
    std::vector<std::string> types_; ///< of the component of each frame within a time
    bool hasNotes_ = false, compact_ = false, knowsBands_ = false, hasStatistics_ = false, knowsSteps_ = false,
         knowsSubsamples_ = false, knowsPredictions_ = false, knowsFits_ = false, knowsMixed_ = false,
         knowsCorrections_ = false, knowsParts_ = false, knowsSteppedIntegers_ = false, knowsNumbers_ = false;
    std::size_t end_ = 0; ///< of the archive in the file
    std::vector<Piece> models_;
    std::vector<Mask> masks_;
    std::vector<Frame> frames_;
};

} // namespace tessera::codec::plain
