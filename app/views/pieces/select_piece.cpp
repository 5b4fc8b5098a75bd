#include "app/views/pieces/select_piece.h"

#include "app/edits/open_worth.h"
#include "app/views/data/derived_list.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

volume::PiecesRecipe piecesRecipeOf(const volume::DatasetInfo& info, const PiecesQuestion& question) {
    return {info.channel(question.channel).name, question.value,
            question.of == PiecesOf::Below ? volume::PieceSide::Below : volume::PieceSide::Above, question.leastVolume};
}

/// The label of these pieces among the derived parameters.
const volume::DerivedParameter* labelOfPieces(const Session& session, const volume::PiecesRecipe& recipe) {
    const auto found = std::ranges::find_if(session.data.derived, [&](const volume::DerivedParameter& each) {
        const auto* own = std::get_if<volume::PiecesRecipe>(&each.recipe);
        return own && *own == recipe;
    });
    return found == session.data.derived.end() ? nullptr : &*found;
}

} // namespace

void selectPiece(Session& session, const volume::DatasetInfo& info, const PiecesQuestion& question,
                 const volume::Piece& piece, bool exact) {
    session.time = info.times[std::size_t(piece.time)];
    session.animation.playing = false;
    session.cursor = piece.centroid;
    if (!exact || question.of == PiecesOf::Selected) return;
    volume::DerivedParameter wanted{.name = "pieces of " + info.channel(question.channel).name,
                                    .unit = "",
                                    .recipe = piecesRecipeOf(info, question)};
    const std::string base = wanted.name;
    const auto taken = [&] {
        return std::ranges::find(session.data.derived, wanted.name, &volume::DerivedParameter::name) !=
                   session.data.derived.end() ||
               info.findChannel(wanted.name).has_value();
    };
    const volume::DerivedParameter* known = labelOfPieces(session, piecesRecipeOf(info, question));
    for (int number = 2; !known && taken(); ++number) wanted.name = base + " " + std::to_string(number);
    const std::string name = known ? known->name : addDerived(session, wanted);
    vis::Brush brush = vis::rangeBrush({{name, piece.track - 0.25, piece.track + 0.25, 0}});
    brush.name = "piece " + std::to_string(piece.track);
    brushAlone(session, std::move(brush));
}

int chosenPiece(const Session& session, const volume::DatasetInfo& info, const PiecesQuestion& question) {
    if (question.of == PiecesOf::Selected) return 0;
    const volume::DerivedParameter* label = labelOfPieces(session, piecesRecipeOf(info, question));
    if (!label) return 0;
    for (const vis::Brush& brush : session.selection.brushes) {
        const auto* region = std::get_if<vis::RangeRegion>(&brush.region);
        if (!brush.enabled || brush.inverted || !region || region->intervals.size() != 1) continue;
        const vis::BrushInterval& interval = region->intervals.front();
        const bool one = interval.hi >= interval.lo && interval.hi - interval.lo < 1;
        if (interval.channel == label->name && one) return int(std::lround(0.5 * (interval.lo + interval.hi)));
    }
    return 0;
}

} // namespace tessera::app
