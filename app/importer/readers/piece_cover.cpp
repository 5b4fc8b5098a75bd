#include "app/importer/readers/piece_cover.h"

#include "volume/system/input_file.h"

#include <algorithm>
#include <charconv>
#include <functional>
#include <stdexcept>
#include <string_view>

namespace tessera::importer {

namespace {

/// The value of an attribute in the text of a tag.
std::optional<std::string> attributeIn(std::string_view tag, std::string_view name) {
    constexpr std::string_view kSpace = " \t\r\n";
    for (std::size_t at = 0; (at = tag.find(name, at)) != std::string_view::npos; at += name.size()) {
        if (at == 0 || kSpace.find(tag[at - 1]) == std::string_view::npos) continue;
        std::size_t mark = tag.find_first_not_of(kSpace, at + name.size());
        if (mark == std::string_view::npos || tag[mark] != '=') continue;
        mark = tag.find_first_not_of(kSpace, mark + 1);
        if (mark == std::string_view::npos || (tag[mark] != '"' && tag[mark] != '\'')) continue;
        const std::size_t end = tag.find(tag[mark], mark + 1);
        if (end == std::string_view::npos) return std::nullopt;
        return std::string(tag.substr(mark + 1, end - mark - 1));
    }
    return std::nullopt;
}

PointExtent extentFrom(const std::string& text) {
    PointExtent extent{};
    const char* at = text.data();
    const char* const end = at + text.size();
    for (int& number : extent) {
        while (at != end && (*at == ' ' || *at == '\t' || *at == '\n' || *at == '\r')) ++at;
        const auto [next, failed] = std::from_chars(at, end, number);
        constexpr int kMost = 1 << 30;
        if (failed != std::errc() || number < -kMost || number > kMost)
            throw std::runtime_error("states an extent that is none: \"" + text.substr(0, 60) + "\"");
        at = next;
    }
    return extent;
}

/// Calls `body` with the text of each tag, up to the appended data.
void eachTag(const std::string& path, const std::function<void(std::string_view)>& body) {
    constexpr std::size_t kPiece = 1 << 20, kLongest = 1 << 16;
    std::ifstream in = openInput(path);
    std::string text;
    std::vector<char> piece(kPiece);
    while (in) {
        in.read(piece.data(), std::streamsize(kPiece));
        text.append(piece.data(), std::size_t(std::max<std::streamsize>(in.gcount(), 0)));
        std::size_t at = 0;
        for (;;) {
            at = text.find('<', at);
            const std::size_t end = at == std::string::npos ? at : text.find('>', at);
            if (end == std::string::npos) break;
            const std::string_view tag = std::string_view(text).substr(at + 1, end - at - 1);
            if (tag.starts_with("AppendedData")) return;
            body(tag);
            at = end + 1;
        }
        if (at == std::string::npos || text.size() - at > kLongest)
            text.clear();
        else
            text.erase(0, at);
    }
}

bool isNamed(std::string_view tag, std::string_view name) {
    return tag.starts_with(name) && (tag.size() == name.size() || !(tag[name.size()] > ' '));
}

bool isGrid(std::string_view tag) {
    for (const std::string_view kind : {"ImageData", "RectilinearGrid", "StructuredGrid"})
        if (isNamed(tag, kind) || (tag.starts_with('P') && isNamed(tag.substr(1), kind))) return true;
    return false;
}

/// Numbers of points or cells along an axis, and the range of them that a part has.
struct AxisRange {
    std::size_t size = 0, first = 0, last = 0; ///< [first, last)
};

AxisRange rangeOf(const PointExtent& whole, const PointExtent& part, std::size_t axis, bool cells) {
    const std::int64_t lo = whole[2 * axis], hi = whole[2 * axis + 1];
    std::int64_t size = std::max<std::int64_t>(0, hi - lo + 1);
    std::int64_t first = std::max<std::int64_t>(0, part[2 * axis] - lo),
                 last = std::min<std::int64_t>(size, part[2 * axis + 1] - lo + 1);
    if (cells && size > 1) { // a flat grid has one layer of cells
        --size;
        --last;
    }
    last = std::max(first, last);
    return {std::size_t(size), std::size_t(first), std::size_t(last)};
}

/// Calls `body` with each layer along z of counts of the parts that hold a point or cell, and with how many layers in a
/// row are alike. Each part costs its four corners, however large it is.
void eachLayer(const GridPieces& pieces, bool cells,
               const std::function<void(const std::vector<int>& counts, std::size_t first, std::size_t alike)>& body) {
    const AxisRange x = rangeOf(pieces.whole, pieces.whole, 0, cells),
                    y = rangeOf(pieces.whole, pieces.whole, 1, cells),
                    z = rangeOf(pieces.whole, pieces.whole, 2, cells);
    constexpr double kMost = double(std::uint64_t(1) << 40);
    if (double(x.size) * double(y.size) * double(z.size) > kMost)
        throw std::runtime_error("states more samples than memory can hold");
    std::vector<std::size_t> starts{0, z.size};
    for (const PointExtent& part : pieces.parts) {
        const AxisRange own = rangeOf(pieces.whole, part, 2, cells);
        starts.push_back(std::min(own.first, z.size));
        starts.push_back(std::min(own.last, z.size));
    }
    std::ranges::sort(starts);
    starts.erase(std::unique(starts.begin(), starts.end()), starts.end());
    for (std::size_t s = 0; s + 1 < starts.size(); ++s) {
        std::vector<int> counts((x.size + 1) * (y.size + 1), 0);
        const auto at = [&](std::size_t i, std::size_t j) -> int& { return counts[j * (x.size + 1) + i]; };
        for (const PointExtent& part : pieces.parts) {
            const AxisRange own[3] = {rangeOf(pieces.whole, part, 0, cells), rangeOf(pieces.whole, part, 1, cells),
                                      rangeOf(pieces.whole, part, 2, cells)};
            if (own[2].first > starts[s] || own[2].last <= starts[s] || own[0].first >= own[0].last ||
                own[1].first >= own[1].last)
                continue;
            ++at(own[0].first, own[1].first);
            --at(own[0].last, own[1].first);
            --at(own[0].first, own[1].last);
            ++at(own[0].last, own[1].last);
        }
        for (std::size_t j = 0; j <= y.size; ++j)
            for (std::size_t i = 1; i <= x.size; ++i) at(i, j) += at(i - 1, j);
        for (std::size_t j = 1; j <= y.size; ++j)
            for (std::size_t i = 0; i <= x.size; ++i) at(i, j) += at(i, j - 1);
        body(counts, starts[s], starts[s + 1] - starts[s]);
    }
}

} // namespace

std::optional<GridPieces> piecesOf(const std::string& path) {
    std::optional<GridPieces> pieces;
    eachTag(path, [&](std::string_view tag) {
        if (!pieces && isGrid(tag)) {
            pieces.emplace();
            pieces->whole = extentFrom(attributeIn(tag, "WholeExtent").value_or(""));
        } else if (pieces && isNamed(tag, "Piece")) {
            pieces->parts.push_back(extentFrom(attributeIn(tag, "Extent").value_or("")));
            if (std::optional<std::string> source = attributeIn(tag, "Source"))
                pieces->sources.push_back(std::move(*source));
        }
    });
    return pieces;
}

std::size_t missingIn(const GridPieces& pieces, bool cells) {
    if (std::ranges::find(pieces.parts, pieces.whole) != pieces.parts.end()) return 0;
    const std::size_t nx = rangeOf(pieces.whole, pieces.whole, 0, cells).size,
                      ny = rangeOf(pieces.whole, pieces.whole, 1, cells).size;
    std::size_t missing = 0;
    eachLayer(pieces, cells, [&](const std::vector<int>& counts, std::size_t, std::size_t alike) {
        for (std::size_t j = 0; j < ny; ++j)
            for (std::size_t i = 0; i < nx; ++i)
                if (counts[j * (nx + 1) + i] == 0) missing += alike;
    });
    return missing;
}

std::vector<std::uint8_t> heldBy(const GridPieces& pieces, bool cells) {
    if (missingIn(pieces, cells) == 0) return {};
    const std::size_t nx = rangeOf(pieces.whole, pieces.whole, 0, cells).size,
                      ny = rangeOf(pieces.whole, pieces.whole, 1, cells).size,
                      nz = rangeOf(pieces.whole, pieces.whole, 2, cells).size;
    std::vector<std::uint8_t> held(nx * ny * nz);
    eachLayer(pieces, cells, [&](const std::vector<int>& counts, std::size_t first, std::size_t alike) {
        for (std::size_t k = first; k < first + alike; ++k)
            for (std::size_t j = 0; j < ny; ++j)
                for (std::size_t i = 0; i < nx; ++i)
                    held[(k * ny + j) * nx + i] = counts[j * (nx + 1) + i] != 0 ? 1 : 0;
    });
    return held;
}

} // namespace tessera::importer
