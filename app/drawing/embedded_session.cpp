#include "app/drawing/embedded_session.h"

#include "volume/base/error.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <utility>
#include <zlib.h>

namespace tessera::app {

namespace {

constexpr std::array<std::pair<std::string_view, char>, 4> kEntities{
    {{"&lt;", '<'}, {"&gt;", '>'}, {"&amp;", '&'}, {"&quot;", '"'}}};

constexpr std::size_t kLongestSession = std::size_t(1) << 28; ///< bytes; a larger one is not unpacked

/// What follows a key in a PDF's dictionaries as a number, from a place on; nothing where it does not follow.
std::optional<std::size_t> numberAfter(std::string_view pdf, std::string_view key, std::size_t from) {
    std::size_t at = pdf.find(key, from);
    if (at == std::string_view::npos) return std::nullopt;
    at = pdf.find_first_not_of(" \r\n", at + key.size());
    std::size_t number = 0;
    if (at == std::string_view::npos ||
        std::from_chars(pdf.data() + at, pdf.data() + pdf.size(), number).ec != std::errc())
        return std::nullopt;
    return number;
}

/// The dictionary of an object, from "<<" to the ">>" before the end of the object.
std::optional<std::string_view> dictionaryOf(std::string_view pdf, std::size_t object) {
    const std::size_t head = pdf.rfind("\n" + std::to_string(object) + " 0 obj");
    if (head == std::string_view::npos) return std::nullopt;
    const std::size_t end = pdf.find("endobj", head), begin = pdf.find("<<", head);
    if (end == std::string_view::npos || begin > end) return std::nullopt;
    const std::size_t last = pdf.rfind(">>", end);
    if (last == std::string_view::npos || last < begin) return std::nullopt;
    return pdf.substr(begin, last + 2 - begin);
}

std::string packed(std::string_view text) {
    uLongf size = compressBound(static_cast<uLong>(text.size()));
    std::string out(size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(text.data()),
                  static_cast<uLong>(text.size()), Z_BEST_COMPRESSION) != Z_OK)
        throw MachineError("the session cannot be packed for a PDF");
    out.resize(size);
    return out;
}

/// A line of a cross-reference table, 20 bytes.
std::string tableLine(std::size_t offset) {
    char line[32];
    std::snprintf(line, sizeof line, "%010zu 00000 n \n", offset);
    return line;
}

} // namespace

std::string escapedXml(std::string_view text) {
    std::string out;
    for (const char c : text) {
        const auto found = std::ranges::find(kEntities, c, [](const auto& entity) { return entity.second; });
        found == kEntities.end() ? out += c : out += found->first;
    }
    return out;
}

std::string sessionElement(std::string_view session) {
    return "<metadata id=\"" + std::string(kSessionElement) + "\">" + escapedXml(session) + "</metadata>\n";
}

std::optional<std::string> sessionInSvg(std::string_view svg) {
    const std::string head = "<metadata id=\"" + std::string(kSessionElement) + "\">";
    const std::size_t begin = svg.find(head);
    if (begin == std::string_view::npos) return std::nullopt;
    const std::size_t end = svg.find("</metadata>", begin);
    if (end == std::string_view::npos) return std::nullopt;
    std::string_view text = svg.substr(begin + head.size(), end - begin - head.size());
    std::string out;
    while (!text.empty()) {
        const auto found =
            std::ranges::find_if(kEntities, [&](const auto& entity) { return text.starts_with(entity.first); });
        out += found == kEntities.end() ? text.front() : found->second;
        text.remove_prefix(found == kEntities.end() ? 1 : found->first.size());
    }
    return out;
}

std::string withAttachedSession(std::string pdf, std::string_view session) {
    const std::size_t trailer = pdf.rfind("\ntrailer"), table = pdf.rfind("startxref");
    const auto size = numberAfter(pdf, "/Size", trailer), root = numberAfter(pdf, "/Root", trailer),
               info = numberAfter(pdf, "/Info", trailer), before = numberAfter(pdf, "startxref", table);
    const auto catalog = root ? dictionaryOf(pdf, *root) : std::nullopt;
    if (trailer == std::string::npos || !size || !before || !catalog || catalog->find("/Names") != std::string::npos)
        throw MachineError("no session can be attached to this PDF");
    const std::size_t file = *size, content = *size + 1;
    const std::string name(kAttachedSession), bytes = packed(session);
    const std::string newCatalog = std::string(catalog->substr(0, catalog->size() - 2)) +
                                   "   /Names << /EmbeddedFiles << /Names [ (" + name + ") " + std::to_string(file) +
                                   " 0 R ] >> >>\n>>";
    if (!pdf.ends_with('\n')) pdf += '\n';
    const auto object = [&](std::size_t number, const std::string& body) {
        const std::size_t offset = pdf.size();
        pdf += std::to_string(number) + " 0 obj\n" + body + "\nendobj\n";
        return offset;
    };
    const std::size_t atRoot = object(*root, newCatalog);
    const std::size_t atFile = object(
        file, "<< /Type /Filespec /F (" + name + ") /UF (" + name + ")\n   /EF << /F " + std::to_string(content) +
                  " 0 R >>\n   /Desc (Tessera opens this picture as the session that it shows) >>");
    const std::size_t atContent =
        object(content, "<< /Type /EmbeddedFile /Subtype /application#2Fjson /Filter /FlateDecode\n   /Length " +
                            std::to_string(bytes.size()) + " /Params << /Size " + std::to_string(session.size()) +
                            " >> >>\nstream\n" + bytes + "\nendstream");
    const std::size_t atTable = pdf.size();
    pdf += "xref\n" + std::to_string(*root) + " 1\n" + tableLine(atRoot) + std::to_string(file) + " 2\n" +
           tableLine(atFile) + tableLine(atContent) + "trailer\n<< /Size " + std::to_string(content + 1) +
           "\n   /Root " + std::to_string(*root) + " 0 R\n";
    if (info) pdf += "   /Info " + std::to_string(*info) + " 0 R\n";
    return pdf + "   /Prev " + std::to_string(*before) + "\n>>\nstartxref\n" + std::to_string(atTable) + "\n%%EOF\n";
}

std::optional<std::string> sessionInPdf(std::string_view pdf, const std::string& name) {
    const std::size_t named = pdf.rfind("/F (" + std::string(kAttachedSession) + ")");
    if (named == std::string_view::npos) return std::nullopt;
    const auto damaged = [&] { return Error("the session attached to this PDF is damaged", name); };
    const std::size_t object = pdf.find("/EmbeddedFile ", named), stream = pdf.find("stream\n", object);
    const auto length = numberAfter(pdf, "/Length", object), size = numberAfter(pdf, "/Size", object);
    if (object == std::string_view::npos || stream == std::string_view::npos || !length || !size) throw damaged();
    const std::string_view bytes = pdf.substr(stream + 7);
    if (*length > bytes.size() || *size > kLongestSession) throw damaged();
    std::string out(*size, '\0');
    uLongf written = static_cast<uLongf>(out.size());
    if (uncompress(reinterpret_cast<Bytef*>(out.data()), &written, reinterpret_cast<const Bytef*>(bytes.data()),
                   static_cast<uLong>(*length)) != Z_OK ||
        written != out.size())
        throw damaged();
    return out;
}

} // namespace tessera::app
