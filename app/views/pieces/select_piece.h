#pragma once

#include "app/session/session.h"
#include "app/views/pieces/pieces_data.h"

#include <string>

/// A piece of the graph as the selection of the session.
namespace tessera::app {

/// Goes to a piece: the time and the cross-hair to its centre. Pieces above or below a value are brushed, too, in
/// space and at all times that have their number: exactly, by a derived parameter that labels every sample with the
/// number of its piece (volume::PiecesRecipe), which is added where it is not there, and whose brush becomes the only
/// one that is enabled. `exact`: numbers are those of that parameter; else, and of pieces of a selection, nothing is
/// brushed.
void selectPiece(Session& session, const volume::DatasetInfo& info, const PiecesQuestion& question,
                 const volume::Piece& piece, bool exact);

/// The number of the piece that is brushed so; 0: none.
int chosenPiece(const Session& session, const volume::DatasetInfo& info, const PiecesQuestion& question);

} // namespace tessera::app
