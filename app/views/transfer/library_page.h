#pragma once

#include "app/queries/async_query.h"
#include "app/user_files/own_functions.h"
#include "app/views/transfer/library_pictures.h"

#include <memory>
#include <string>

namespace tessera::app {

/// The library of transfer functions as small pictures of the data; a click applies one. One per view.
struct LibraryPage {
    struct Query {
        int channel = 0, time = 0;
        bool operator==(const Query&) const = default;
    };
    LibraryPictures pictures;
    AsyncQuery<Query, vis::ValueDistribution> values;
    OwnFunctions own;
    bool loaded = false; ///< `own`, of the state folder
    std::string name;    ///< under which the function in use is being saved
};

/// Pictures in rows of a page of this width, pixels: two of them have room beside each other unless they would show
/// nothing.
struct LibraryGrid {
    float side; ///< of a picture
    int columns;
};
LibraryGrid libraryGrid(float room);

/// `function`: the name in Session::transfer of what is edited, a function of the channel's values.
void drawLibraryPage(ViewContext& context, LibraryPage& page, const std::string& function, int channel);

} // namespace tessera::app
