// NetCDF's classic library silently reads zeros beyond the end of a file, so truncated ones are found here.
#include "app/importer/readers/check_file.h"

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace tessera::importer {

namespace {

/// The header of a classic file: big-endian numbers, names and values padded to four bytes.
class ClassicHeader {
public:
    explicit ClassicHeader(const std::string& path) : path_(path) {
        bytes_ = readPart(path, 0, 1 << 16);
        version_ = bytes_.size() > 3 ? bytes_[3] : 0;
        at_ = 4;
    }
    bool isClassic() const { return bytes_.starts_with("CDF") && (version_ == 1 || version_ == 2 || version_ == 5); }
    /// Minimum size of the file in bytes, without the padding of its last value.
    double bytesNeeded() {
        const double records = count();
        const bool streaming = records >= (version_ == 5 ? 1.8e19 : 4294967295.0);
        readDimensions();
        skipAttributes();
        struct Variable {
            double begin, bytes;
        };
        std::vector<Variable> perRecord;
        double end = 0;
        const auto variables = tagged();
        for (std::size_t v = 0; v < variables; ++v) {
            skip(padded(size()));
            const std::size_t rank = size();
            if (rank > 1024) throw std::runtime_error("has a damaged header"); // as NetCDF limits it
            std::vector<std::size_t> axes(rank);
            for (std::size_t& axis : axes) axis = size();
            skipAttributes();
            const double one = bytesOf(number(4));
            count(); // stored size of the variable: not used, since it overflows in large files
            const double begin = version_ == 1 ? number(4) : number(8);
            double bytes = one;
            bool growing = false;
            for (std::size_t i = 0; i < axes.size(); ++i) {
                if (axes[i] >= lengths_.size()) throw std::runtime_error("has a damaged header");
                const bool unlimited = lengths_[axes[i]] == 0;
                growing = growing || (i == 0 && unlimited);
                if (!unlimited) bytes *= lengths_[axes[i]];
            }
            if (growing)
                perRecord.push_back({begin, bytes});
            else
                end = std::max(end, begin + bytes);
        }
        double record = 0;
        for (const Variable& variable : perRecord)
            record += perRecord.size() == 1 ? variable.bytes : 4 * double(std::uint64_t((variable.bytes + 3) / 4));
        if (!streaming && records > 0)
            for (const Variable& variable : perRecord)
                end = std::max(end, variable.begin + (records - 1) * record + variable.bytes);
        return end;
    }

private:
    static double bytesOf(double type) {
        constexpr double kBytes[] = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
        if (type < 1 || type > 11) throw std::runtime_error("has a damaged header");
        return kBytes[static_cast<std::size_t>(type)];
    }
    static std::size_t padded(std::size_t bytes) { return (bytes + 3) / 4 * 4; }
    void need(std::size_t bytes) {
        if (at_ + bytes <= bytes_.size()) return;
        const std::size_t whole = bytesIn(path_); // before memory is taken for what a damaged header states
        if (at_ + bytes > whole) throw std::runtime_error("ends within its header: truncated");
        bytes_ = readPart(path_, 0, std::min(whole, std::max(bytes_.size() * 2, at_ + bytes)));
    }
    double number(std::size_t bytes) {
        need(bytes);
        double value = 0;
        for (std::size_t i = 0; i < bytes; ++i) value = value * 256 + static_cast<unsigned char>(bytes_[at_ + i]);
        at_ += bytes;
        return value;
    }
    double count() { return number(version_ == 5 ? 8 : 4); }
    std::size_t size() {
        const double value = count();
        if (value > 1e9) throw std::runtime_error("has a damaged header");
        return static_cast<std::size_t>(value);
    }
    void skip(std::size_t bytes) {
        need(bytes);
        at_ += bytes;
    }
    std::size_t tagged() {
        number(4);
        return size();
    }
    void readDimensions() {
        const auto dimensions = tagged();
        for (std::size_t d = 0; d < dimensions; ++d) {
            skip(padded(size()));
            lengths_.push_back(count());
        }
    }
    void skipAttributes() {
        const auto attributes = tagged();
        for (std::size_t a = 0; a < attributes; ++a) {
            skip(padded(size()));
            const double one = bytesOf(number(4));
            skip(padded(static_cast<std::size_t>(one) * size()));
        }
    }

    std::string path_, bytes_;
    int version_ = 0;
    std::size_t at_ = 0;
    std::vector<double> lengths_; ///< of the dimensions; 0 = grows by records
};

} // namespace

void checkNetCdf(const std::string& path) {
    ClassicHeader header(path);
    if (!header.isClassic()) return;
    wantBytes(double(bytesIn(path)), header.bytesNeeded(), {}, "bytes");
}

} // namespace tessera::importer
