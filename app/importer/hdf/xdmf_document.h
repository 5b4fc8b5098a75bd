#pragma once

#include <map>
#include <memory>
#include <pugixml.hpp>
#include <string>
#include <vector>

/// The light data of XDMF 2 and 3: one or several files of XML that point into each other.
namespace tessera::importer {

/// A file of XML and those that it includes. Nodes stay where they stand: an included Topology is the same node for all
/// grids that include it. "XDMF Model and Format", www.xdmf.org; XInclude with pointers as solvers write them.
class XdmfDocument {
public:
    /// Throws where the file is no XML, or ends before its last tag.
    explicit XdmfDocument(const std::string& path);

    pugi::xml_node root() const { return first_->document.document_element(); }
    /// The elements below a node, with those that xi:include names instead of it, and each one that is a Reference
    /// replaced by what it refers to. What cannot be found is missing, and noted.
    std::vector<pugi::xml_node> children(pugi::xml_node parent, const char* name = nullptr) const;
    pugi::xml_node child(pugi::xml_node parent, const char* name) const;
    /// The folder of the file that a node stands in.
    std::string pathOf(pugi::xml_node node) const;
    /// What was not found, one sentence each, without repetition.
    const std::vector<std::string>& notes() const { return notes_; }

private:
    struct Loaded {
        std::string path;
        pugi::xml_document document;
    };
    const Loaded* load(const std::string& path) const;
    std::vector<pugi::xml_node> included(pugi::xml_node include) const;
    pugi::xml_node referred(pugi::xml_node node) const;
    void note(const std::string& text) const;

    mutable std::map<std::string, std::shared_ptr<const Loaded>> files_; ///< by path; null where it cannot be read
    mutable std::vector<std::string> notes_;
    const Loaded* first_ = nullptr;
};

/// An attribute by the first of its names that is there, in any case of its letters; "" where there is none.
std::string xdmfAttribute(pugi::xml_node node, std::initializer_list<const char*> names);

/// In small letters, without blanks around it.
std::string xdmfWord(const std::string& text);

/// Numbers separated by blanks or commas. Throws where one is none.
std::vector<double> xdmfNumbers(const std::string& text);

/// The same for sizes.
std::vector<std::size_t> xdmfSizes(const std::string& text);

} // namespace tessera::importer
