#pragma once

#include "app/importer/pictures/pixels.h"

#include <string>
#include <vector>

/// Pictures that hold one slice each.
namespace tessera::importer {

struct Picture {
    PixelForm form;
    std::vector<char> rows;         ///< as PixelForm says
    std::vector<std::string> names; ///< of the samples of a pixel
    std::string note;               ///< for the user: what became of its colours; "" = nothing to say
};

/// Each throws std::runtime_error with one line where the file is damaged, or of another kind. Sizes are checked before
/// memory is taken.
Picture readPng(const std::string& path);
Picture readJpeg(const std::string& path);
Picture readBmp(const std::string& path);
Picture readPnm(const std::string& path);

/// Pixels of a palette: its greys if all its colours are grey, else the indices with a note on that. `palette` holds
/// red, green and blue of each index.
void applyPalette(Picture& picture, const std::vector<unsigned char>& palette);

/// Names of the samples of a pixel by their number: grey, grey with alpha, colours, colours with alpha.
std::vector<std::string> pictureNames(int samples);

} // namespace tessera::importer
