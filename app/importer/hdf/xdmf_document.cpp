#include "app/importer/hdf/xdmf_document.h"

#include "app/importer/readers/check_file.h"
#include "volume/base/trimmed.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <set>
#include <stdexcept>

namespace tessera::importer {

namespace fs = std::filesystem;

namespace {

constexpr int kMostLinks = 16; // of includes and references after each other

/// Replaces the entities that the document type declares: XDMF 2 names its heavy data so, "&HeavyData;:/T".
std::string withEntities(std::string text) {
    const std::size_t begin = text.find("<!DOCTYPE"), open = text.find('[', begin), end = text.find("]>", open);
    if (begin == std::string::npos || open == std::string::npos || end == std::string::npos) return text;
    const std::string declared = text.substr(open, end - open);
    std::size_t grown = 0;
    for (std::size_t at = 0; (at = declared.find("<!ENTITY", at)) != std::string::npos; ++at) {
        const std::size_t name = declared.find_first_not_of(" \t\r\n", at + 8);
        const std::size_t stop = declared.find_first_of(" \t\r\n", name);
        const std::size_t quote = declared.find_first_of("\"'", stop);
        if (name == std::string::npos || stop == std::string::npos || quote == std::string::npos) break;
        const std::size_t close = declared.find(declared[quote], quote + 1);
        if (close == std::string::npos) break;
        const std::string entity = "&" + declared.substr(name, stop - name) + ";";
        const std::string value = declared.substr(quote + 1, close - quote - 1);
        for (std::size_t use = end; (use = text.find(entity, use)) != std::string::npos; use += value.size()) {
            constexpr std::size_t kMostGrowth = std::size_t(64) << 20;
            if ((grown += value.size()) > kMostGrowth) throw std::runtime_error("declares entities without end");
            text.replace(use, entity.size(), value);
        }
    }
    return text;
}

/// Nodes by an XPath; none where it is not one.
std::vector<pugi::xml_node> selected(pugi::xml_node from, const std::string& path) {
    std::vector<pugi::xml_node> nodes;
    try {
        for (const pugi::xpath_node& found : from.select_nodes(path.c_str()))
            if (found.node()) nodes.push_back(found.node());
    } catch (const pugi::xpath_exception&) {
        return {};
    }
    return nodes;
}

/// What stands between the outermost brackets: "xpointer(//Grid[1])" points to "//Grid[1]".
std::string inBrackets(const std::string& text) {
    const std::size_t begin = text.find('('), end = text.rfind(')');
    return begin == std::string::npos || end == std::string::npos || end < begin
               ? text
               : text.substr(begin + 1, end - begin - 1);
}

/// Nodes by a pointer of XInclude: xpointer(XPATH), element(/1/2), or the id of an element.
std::vector<pugi::xml_node> pointedTo(const pugi::xml_document& document, const std::string& pointer) {
    if (!pointer.starts_with("element(")) return selected(document, inBrackets(pointer));
    pugi::xml_node node = document;
    std::string rest = inBrackets(pointer);
    while (!rest.empty() && rest.front() == '/') {
        std::size_t place = 0;
        const auto parsed = std::from_chars(rest.data() + 1, rest.data() + rest.size(), place);
        if (parsed.ec != std::errc()) return {};
        rest.erase(0, std::size_t(parsed.ptr - rest.data()));
        pugi::xml_node inner = node.first_child();
        for (; inner; inner = inner.next_sibling())
            if (inner.type() == pugi::node_element && --place == 0) break;
        if (!inner) return {};
        node = inner;
    }
    return {node};
}

bool isInclude(pugi::xml_node node) {
    const std::string name = node.name();
    return name == "xi:include" || name == "include" || name.ends_with(":include");
}

} // namespace

std::string xdmfWord(const std::string& text) {
    std::string word(volume::trimmed(text));
    std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return word;
}

std::string xdmfAttribute(pugi::xml_node node, std::initializer_list<const char*> names) {
    for (const char* name : names)
        for (const pugi::xml_attribute& attribute : node.attributes())
            if (xdmfWord(attribute.name()) == xdmfWord(name)) return std::string(volume::trimmed(attribute.value()));
    return {};
}

std::vector<double> xdmfNumbers(const std::string& text) {
    std::vector<double> numbers;
    const char* at = text.data();
    const char* const end = at + text.size();
    for (;;) {
        while (at != end && (std::isspace(static_cast<unsigned char>(*at)) || *at == ',' || *at == ';')) ++at;
        if (at == end) return numbers;
        if (*at == '+') ++at;
        double value = 0;
        const auto parsed = std::from_chars(at, end, value);
        if (parsed.ec == std::errc::invalid_argument)
            throw std::runtime_error("\"" + std::string(at, std::min<std::size_t>(std::size_t(end - at), 20)) +
                                     "\" is no number");
        numbers.push_back(value);
        at = parsed.ptr;
    }
}

std::vector<std::size_t> xdmfSizes(const std::string& text) {
    std::vector<std::size_t> sizes;
    for (const double number : xdmfNumbers(text)) {
        if (!(number >= 0 && number <= 1e12))
            throw std::runtime_error("its dimensions \"" + text.substr(0, 40) + "\" are no sizes");
        sizes.push_back(std::size_t(number));
    }
    return sizes;
}

XdmfDocument::XdmfDocument(const std::string& path) {
    first_ = load(path);
    if (first_ == nullptr || std::string(root().name()) != "Xdmf")
        throw std::runtime_error("is no XDMF file, or ends early");
}

const XdmfDocument::Loaded* XdmfDocument::load(const std::string& path) const {
    if (const auto known = files_.find(path); known != files_.end()) return known->second.get();
    std::shared_ptr<const Loaded>& kept = files_[path];
    std::error_code missing;
    constexpr std::size_t kMostBytes = std::size_t(1) << 30, kMostFiles = 1000;
    if (!fs::is_regular_file(path, missing) || bytesIn(path) > kMostBytes || files_.size() > kMostFiles) return nullptr;
    const auto loaded = std::make_shared<Loaded>();
    loaded->path = path;
    const std::string text = withEntities(readWhole(path));
    if (!loaded->document.load_buffer(text.data(), text.size())) return nullptr;
    kept = loaded;
    return kept.get();
}

void XdmfDocument::note(const std::string& text) const {
    if (std::ranges::find(notes_, text) == notes_.end() && notes_.size() < 20) notes_.push_back(text);
}

std::string XdmfDocument::pathOf(pugi::xml_node node) const {
    for (const auto& [path, file] : files_)
        if (file != nullptr && file->document == node.root()) return path;
    return first_->path;
}

std::vector<pugi::xml_node> XdmfDocument::included(pugi::xml_node include) const {
    const std::string href = xdmfAttribute(include, {"href"}), pointer = xdmfAttribute(include, {"xpointer"});
    const Loaded* file = href.empty() ? nullptr : load(besides(pathOf(include), href));
    if (!href.empty() && file == nullptr) {
        note("its file " + href.substr(0, 100) + " is missing or no XML: left out");
        return {};
    }
    if (file == nullptr)
        for (const auto& [path, other] : files_)
            if (other != nullptr && other->document == include.root()) file = other.get();
    if (file == nullptr) return {};
    if (!pointer.empty()) {
        std::vector<pugi::xml_node> nodes = pointedTo(file->document, pointer);
        if (nodes.empty()) note("the pointer " + pointer.substr(0, 100) + " points to nothing: left out");
        return nodes;
    }
    pugi::xml_node top = file->document.document_element();
    if (std::string(top.name()) != "Xdmf") return {top};
    std::vector<pugi::xml_node> inside; // what a whole file holds, at the place of the include
    for (const pugi::xml_node node : top.child("Domain").children()) inside.push_back(node);
    return inside;
}

pugi::xml_node XdmfDocument::referred(pugi::xml_node node) const {
    for (int link = 0; link < kMostLinks; ++link) {
        const std::string reference = xdmfAttribute(node, {"Reference"});
        if (reference.empty()) return node;
        const std::string path =
            xdmfWord(reference) == "xml" ? std::string(volume::trimmed(node.text().get())) : reference;
        std::vector<pugi::xml_node> found = selected(node.root(), path);
        if (found.empty()) found = selected(node, path);
        if (found.empty()) {
            note("the reference " + path.substr(0, 100) + " points to nothing: left out");
            return {};
        }
        node = found.front();
    }
    note("references that point to each other: left out");
    return {};
}

std::vector<pugi::xml_node> XdmfDocument::children(pugi::xml_node parent, const char* name) const {
    std::vector<pugi::xml_node> pending, found;
    for (const pugi::xml_node node : parent.children()) pending.push_back(node);
    std::reverse(pending.begin(), pending.end());
    int links = 0;
    while (!pending.empty()) {
        const pugi::xml_node node = pending.back();
        pending.pop_back();
        if (node.type() != pugi::node_element) continue;
        if (isInclude(node)) {
            constexpr int kMostIncludes = 100'000;
            if (++links > kMostIncludes) break;
            std::vector<pugi::xml_node> inside = included(node);
            std::erase_if(inside, [&](pugi::xml_node other) { return other == node || other == parent; });
            pending.insert(pending.end(), inside.rbegin(), inside.rend());
            continue;
        }
        if (name != nullptr && std::string(node.name()) != name) continue;
        if (const pugi::xml_node meant = referred(node)) found.push_back(meant);
    }
    return found;
}

pugi::xml_node XdmfDocument::child(pugi::xml_node parent, const char* name) const {
    const std::vector<pugi::xml_node> found = children(parent, name);
    return found.empty() ? pugi::xml_node() : found.front();
}

} // namespace tessera::importer
