#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// The header of an AmiraMesh file: what it defines, its parameters, and where its arrays lie.
namespace tessera::importer {

/// "Lattice { float[3] Data } @1(HxZip,1234)".
struct AmiraArray {
    std::string of, type, name; ///< what it belongs to ("Lattice", "Coordinates"), "float", "Data"
    int components = 1;
    int section = 0;
    std::string encoding;   ///< "HxByteRLE", "HxZip"; "" = none
    std::size_t stored = 0; ///< bytes of an encoded one
};

struct AmiraHeader {
    bool text = false, bigEndian = true;
    std::size_t end = 0;                                ///< bytes of the header
    std::map<std::string, std::vector<double>> defines; ///< "Lattice" -> 10, 11, 12
    std::vector<AmiraArray> arrays;
    std::map<std::string, std::string> parameters; ///< "Parameters/Units/Coordinates" -> words, parted by blanks
    std::vector<std::string> blocks;               ///< their paths in order: "Parameters/Materials/Exterior"
};

/// Throws std::runtime_error where the text is no header of AmiraMesh.
AmiraHeader parseAmira(const std::string& text);

} // namespace tessera::importer
