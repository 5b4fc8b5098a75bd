#include "app/importer/dicom/dicom_elements.h"

#include "volume/base/trimmed.h"
#include "volume/system/mapped_file.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <zlib.h>

namespace tessera::importer {

namespace {

constexpr std::uint32_t kUndefined = 0xffffffff;
constexpr DicomTag kItem = 0xfffee000, kItemEnd = 0xfffee00d, kSequenceEnd = 0xfffee0dd;
constexpr int kDeepest = 16; // of nested sequences

[[noreturn]] void endsEarly() {
    throw std::runtime_error("ends early: truncated");
}

bool isSampleTag(DicomTag tag) {
    return tag == dicom_tag::kPixels || tag == dicom_tag::kFloatPixels || tag == dicom_tag::kDoublePixels;
}

/// Finds elements, with explicit or implicit types, in either order of bytes.
class DicomScan {
public:
    DicomScan(std::span<const std::byte> bytes, std::size_t at, bool typed, bool big)
        : bytes_(bytes), at_(at), typed_(typed), big_(big) {}

    std::size_t at() const { return at_; }
    bool atEnd() const { return at_ >= bytes_.size(); }
    std::uint16_t group() const {
        DicomScan ahead = *this;
        return static_cast<std::uint16_t>(ahead.take(2));
    }

    /// The next element of an item that ends at `end`; false at its end mark.
    bool element(DicomItem& item, std::size_t end, int depth, DicomPixels* pixels) {
        const std::uint32_t group = take(2);
        DicomElement one;
        one.tag = group << 16 | take(2);
        one.big = big_;
        if (one.tag == kItemEnd || one.tag == kSequenceEnd) {
            take(4);
            return false;
        }
        const std::uint32_t length = takeLength(one);
        if (pixels != nullptr && isSampleTag(one.tag)) {
            takePixels(one, length, *pixels);
            return true;
        }
        if (length != kUndefined && length > end - at_) endsEarly();
        takeValue(one, length, depth);
        if ((one.tag >> 16) % 2 != 0) one.items.clear(); // private: nothing in it is used
        item.elements.push_back(std::move(one));
        return true;
    }

private:
    std::uint32_t take(std::size_t count) {
        if (bytes_.size() - at_ < count) endsEarly();
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < count; ++i)
            value = value << 8 | std::to_integer<std::uint32_t>(bytes_[at_ + (big_ ? i : count - 1 - i)]);
        at_ += count;
        return value;
    }

    std::uint32_t takeLength(DicomElement& one) {
        if (!typed_ || one.tag == kItem) return take(4);
        if (bytes_.size() - at_ < 4) endsEarly();
        const auto letter = [&](std::size_t i) { return std::to_integer<char>(bytes_[at_ + i]); };
        const auto isLetter = [](char c) { return c >= 'A' && c <= 'Z'; };
        if (!isLetter(letter(0)) || !isLetter(letter(1))) return take(4); // written without a type all the same
        one.type[0] = letter(0);
        one.type[1] = letter(1);
        at_ += 2;
        static constexpr std::string_view kLong = "OB OD OF OL OV OW SQ SV UC UN UR UT UV";
        if (kLong.find(std::string_view(one.type, 2)) == std::string_view::npos) return take(2);
        take(2);
        return take(4);
    }

    void takeValue(DicomElement& one, std::uint32_t length, int depth) {
        const bool unknown = one.type[0] == 'U' && one.type[1] == 'N';
        const bool stated = one.type[0] == 'S' && one.type[1] == 'Q';
        if (length == kUndefined || stated) {
            takeItems(one, length, depth, typed_ && !unknown);
            return;
        }
        const std::size_t begin = at_;
        one.value = bytes_.subspan(begin, length);
        const bool perhaps = (unknown || one.type[0] == 0) && length >= 8 && (one.tag >> 16) % 2 == 0;
        DicomScan ahead = *this;
        if (perhaps && (ahead.take(2) << 16 | ahead.take(2)) == kItem) try {
                takeItems(one, length, depth, false);
            } catch (const std::runtime_error&) { // other bytes that begin like a sequence
                one.items.clear();
            }
        at_ = begin + length;
    }

    void takeItems(DicomElement& one, std::uint32_t length, int depth, bool typed) {
        if (depth > kDeepest) throw std::runtime_error("has sequences nested too deep");
        const bool wasTyped = typed_;
        const std::size_t end = length == kUndefined ? bytes_.size() : at_ + length;
        typed_ = typed;
        while (at_ < end) {
            const std::uint32_t group = take(2), tag = group << 16 | take(2), size = take(4);
            if (tag == kSequenceEnd) {
                typed_ = wasTyped;
                return;
            }
            if (tag != kItem) throw std::runtime_error("has a damaged sequence");
            if (size != kUndefined && size > bytes_.size() - at_) endsEarly();
            const std::size_t itemEnd = size == kUndefined ? bytes_.size() : at_ + size;
            DicomItem item;
            bool marked = false;
            while (!marked && at_ < itemEnd) marked = !element(item, itemEnd, depth + 1, nullptr);
            if (!marked && size == kUndefined) endsEarly();
            one.items.push_back(std::move(item));
        }
        if (length == kUndefined) endsEarly();
        typed_ = wasTyped;
    }

    void takePixels(const DicomElement& one, std::uint32_t length, DicomPixels& pixels) {
        pixels.tag = one.tag;
        pixels.big = big_;
        std::copy_n(one.type, 2, pixels.type);
        const auto span = [&](std::uint32_t size) {
            if (size > bytes_.size() - at_)
                throw std::runtime_error("has " + std::to_string(bytes_.size() - at_) +
                                         " bytes of samples, but its header announces " + std::to_string(size));
            at_ += size;
            return bytes_.subspan(at_ - size, size);
        };
        if (length != kUndefined) {
            pixels.bytes = span(length);
            pixels.whole = true;
            return;
        }
        pixels.encapsulated = true;
        for (bool first = true;; first = false) {
            const std::uint32_t group = take(2), tag = group << 16 | take(2), size = take(4);
            pixels.whole = tag == kSequenceEnd;
            if (pixels.whole) return;
            if (tag != kItem) throw std::runtime_error("has damaged compressed samples");
            if (first)
                pixels.offsets = span(size);
            else
                pixels.fragments.push_back(span(size));
        }
    }

    std::span<const std::byte> bytes_;
    std::size_t at_;
    bool typed_, big_;
};

/// Whether elements state their types, and the order of bytes, by the first of them.
bool looksTyped(std::span<const std::byte> bytes, std::size_t at) {
    if (bytes.size() - at < 6) return false;
    const auto isLetter = [](std::byte b) { return b >= std::byte('A') && b <= std::byte('Z'); };
    return isLetter(bytes[at + 4]) && isLetter(bytes[at + 5]);
}

std::vector<std::byte> inflateRest(std::span<const std::byte> bytes) {
    constexpr std::size_t kMost = std::size_t(1) << 30;
    z_stream stream{};
    if (inflateInit2(&stream, -15) != Z_OK) throw std::runtime_error("cannot be decompressed");
    std::vector<std::byte> out, part(1 << 18);
    int status = Z_OK;
    std::size_t at = 0;
    while (status == Z_OK) {
        if (stream.avail_in == 0) {
            const std::size_t count = std::min<std::size_t>(bytes.size() - at, 1 << 20);
            stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(bytes.data() + at));
            stream.avail_in = static_cast<unsigned>(count);
            at += count;
        }
        stream.next_out = reinterpret_cast<Bytef*>(part.data());
        stream.avail_out = static_cast<unsigned>(part.size());
        status = inflate(&stream, Z_NO_FLUSH);
        out.insert(out.end(), part.begin(), part.end() - std::ptrdiff_t(stream.avail_out));
        if (out.size() > kMost) break;
    }
    inflateEnd(&stream);
    if (out.size() > kMost)
        throw std::runtime_error(
            "is deflated from more than 1 GiB, which is not read: write it as it is (dcmconv +te)");
    if (status != Z_STREAM_END) endsEarly();
    return out;
}

/// Binary types of what is used here, for files that do not state them; else text.
const char* typeUnstated(DicomTag tag) {
    static constexpr DicomTag kDoubles[] = {0x00189079, 0x00189082, 0x00189087, 0x0018602c, 0x0018602e, 0x0020930d,
                                            0x00209153, 0x00209301, 0x00209302, 0x00409224, 0x00409225};
    static constexpr DicomTag kLongs[] = {0x00209128, 0x00209157, 0x00186012, 0x00041212};
    static constexpr DicomTag kTags[] = {0x00209165, 0x00209167, 0x00280009};
    if (std::ranges::find(kDoubles, tag) != std::end(kDoubles)) return "FD";
    if (std::ranges::find(kLongs, tag) != std::end(kLongs)) return "UL";
    if (std::ranges::find(kTags, tag) != std::end(kTags)) return "AT";
    const std::uint32_t group = tag >> 16, number = tag & 0xffff;
    const bool pixel = group == 0x28 && (number == 2 || number == 6 || number == 0x10 || number == 0x11 ||
                                         (number >= 0x100 && number <= 0x121) || number == 0x3002);
    const bool vector = group == 0x54 && number <= 0x100;
    const bool segment = group == 0x62 && (number == 4 || number == 0xb || number == 0xe);
    if (pixel || vector || segment || tag == 0x00186024 || tag == 0x00186026) return "US";
    return "DS";
}

double binaryNumber(const std::byte* from, std::size_t size, bool big, char kind, bool isSigned) {
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < size; ++i)
        bits = bits << 8 | std::to_integer<std::uint64_t>(from[big ? i : size - 1 - i]);
    if (kind == 'F') return size == 4 ? std::bit_cast<float>(std::uint32_t(bits)) : std::bit_cast<double>(bits);
    if (!isSigned) return double(bits);
    const int unused = 64 - 8 * int(size);
    return double(std::int64_t(bits << unused) >> unused);
}

} // namespace

const DicomElement* DicomItem::find(DicomTag tag) const {
    const auto at = std::ranges::find(elements, tag, &DicomElement::tag);
    return at == elements.end() ? nullptr : &*at;
}

std::string DicomItem::text(DicomTag tag) const {
    const DicomElement* one = find(tag);
    if (one == nullptr) return {};
    std::string out(reinterpret_cast<const char*>(one->value.data()), one->value.size());
    std::erase(out, '\0');
    return std::string(volume::trimmed(out));
}

std::vector<std::string> DicomItem::words(DicomTag tag) const {
    const std::string all = text(tag);
    std::vector<std::string> out;
    for (std::size_t at = 0; at <= all.size() && !all.empty();) {
        const std::size_t end = std::min(all.size(), all.find('\\', at));
        out.emplace_back(volume::trimmed(std::string_view(all).substr(at, end - at)));
        at = end + 1;
    }
    return out;
}

std::vector<double> DicomItem::numbers(DicomTag tag) const {
    const DicomElement* one = find(tag);
    if (one == nullptr) return {};
    std::string type(one->type, one->type[0] != 0 ? 2 : 0);
    if (type.empty() || type == "UN") type = typeUnstated(tag);
    std::size_t size = 0;
    if (type == "US" || type == "SS" || type == "OW" || type == "AT") size = 2;
    if (type == "UL" || type == "SL" || type == "FL" || type == "OF" || type == "OL") size = 4;
    if (type == "FD" || type == "OD" || type == "UV" || type == "SV" || type == "OV") size = 8;
    std::vector<double> out;
    if (size > 0) {
        const char kind = type == "FL" || type == "FD" || type == "OF" || type == "OD" ? 'F' : 'I';
        for (std::size_t at = 0; at + size <= one->value.size(); at += size) {
            double value = binaryNumber(one->value.data() + at, size, one->big, kind, type[0] == 'S');
            if (type == "AT" && at + 4 <= one->value.size()) { // a tag: its group, then its element
                value = value * 65536 + binaryNumber(one->value.data() + at + 2, 2, one->big, 'I', false);
                at += 2;
            }
            if (!std::isfinite(value)) return {};
            out.push_back(value);
        }
        return out;
    }
    for (const std::string& word : words(tag)) {
        const std::string_view digits = word.starts_with('+') ? std::string_view(word).substr(1) : word;
        double value = 0;
        const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        if (parsed.ec != std::errc() || !std::isfinite(value)) return {};
        out.push_back(value);
    }
    return out;
}

std::optional<double> DicomItem::number(DicomTag tag) const {
    const std::vector<double> all = numbers(tag);
    return all.empty() ? std::nullopt : std::optional(all.front());
}

const std::vector<DicomItem>& DicomItem::items(DicomTag tag) const {
    static const std::vector<DicomItem> kNone;
    const DicomElement* one = find(tag);
    return one == nullptr ? kNone : one->items;
}

const DicomItem* DicomItem::item(DicomTag tag) const {
    const std::vector<DicomItem>& all = items(tag);
    return all.empty() ? nullptr : &all.front();
}

DicomFile::DicomFile(const std::string& path) {
    const auto file = std::make_shared<const MappedFile>(path);
    owner_ = file;
    const FilePart whole = file->part({0, file->size()});
    std::span<const std::byte> bytes = whole.bytes();
    const bool marked = bytes.size() >= 132 && std::memcmp(bytes.data() + 128, "DICM", 4) == 0;
    std::size_t at = marked ? 132 : 0;
    const auto byteAt = [&bytes](std::size_t i) { return i < bytes.size() ? std::to_integer<int>(bytes[i]) : -1; };
    const bool known =
        (byteAt(at + 1) == 0 && (byteAt(at) == 2 || byteAt(at) == 8)) || (byteAt(at) == 0 && byteAt(at + 1) == 8);
    if (!marked && !known) {
        const auto head = bytes.first(std::min<std::size_t>(bytes.size(), 128));
        if (std::ranges::any_of(head, [](std::byte b) { return b != std::byte(0); }))
            throw DicomUnread("is not a DICOM file");
        throw std::runtime_error("is truncated or not a DICOM file");
    }
    DicomItem meta;
    DicomScan head(bytes, at, looksTyped(bytes, at), false);
    while (!head.atEnd() && head.group() == 2) head.element(meta, bytes.size(), 0, nullptr);
    at = head.at();
    syntax_ = meta.text(0x00020010);
    if (syntax_ == "1.2.840.10008.1.2.1.99") {
        const auto inflated = std::make_shared<const std::vector<std::byte>>(inflateRest(bytes.subspan(at)));
        owner_ = inflated;
        bytes = *inflated;
        at = 0;
    }
    DicomScan scan(bytes, at, looksTyped(bytes, at), byteAt(at) == 0 && byteAt(at + 1) > 0);
    try {
        while (!scan.atEnd()) scan.element(data_, bytes.size(), 0, &pixels_);
    } catch (const std::runtime_error&) {
        if (!pixels_.whole) throw; // else what follows the samples is filling
    }
    if (syntax_ == "1.2.840.113619.5.2") pixels_.big = true; // of GE: samples alone
}

} // namespace tessera::importer
