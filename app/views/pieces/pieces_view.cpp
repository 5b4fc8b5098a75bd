#include "app/pages/plot_page.h"
#include "app/pane/view_parts.h"
#include "app/plots/plot_view.h"
#include "app/queries/async_query.h"
#include "app/ui/number_field.h"
#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "app/ui/widgets.h"
#include "app/values/place_text.h"
#include "app/views/pieces/pieces_data.h"
#include "app/views/pieces/select_piece.h"
#include "volume/derived/derived.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tessera::app {

namespace {

struct PiecesCache : ViewCache {
    using Answers = AsyncQuery<PiecesQuestion, volume::PieceGraph>;
    Answers answers;
    Answers::AnswerPointer laidOut; ///< what `layout` is of
    PiecesLayout layout;
    bool onPiece = false; ///< the mouse was pressed on a piece
};

constexpr std::array kPiecesOfTitles{"of at least", "of at most", "of the selection"};

void chooseSide(ToolRow& tools, const Session& session, PiecesView& view) {
    if (!tools.next(em() * 8)) return;
    ImGui::SetNextItemWidth(em() * 8);
    if (ImGui::BeginCombo("##of", kPiecesOfTitles[std::size_t(view.of)])) {
        for (std::size_t i = 0; i < kPiecesOfTitles.size(); ++i) {
            const bool offered =
                PiecesOf(i) != PiecesOf::Selected || session.selection.active() || view.of == PiecesOf(i);
            if (offered && ImGui::Selectable(kPiecesOfTitles[i], std::size_t(view.of) == i)) view.of = PiecesOf(i);
        }
        ImGui::EndCombo();
    } else if (ImGui::IsItemHovered()) {
        tooltip("Pieces of samples of at least or at most a value, or of what the brushes select (degree of interest "
                "of at least 0.5)");
    }
}

void choosePiecesValue(ToolRow& tools, const volume::DatasetInfo& info, int channel, PiecesView& view) {
    if (view.of == PiecesOf::Selected || !tools.next(em() * 8)) return;
    const volume::Channel known = info.channel(channel);
    const Range range = info.channelRange(known);
    double value = piecesValue(view, info, channel);
    ImGui::SetNextItemWidth(em() * 8);
    const std::string unit = known.unit.empty() ? "" : " " + prettyUnit(known.unit);
    std::string format = "%.5g";
    for (const char c : unit) format += c == '%' ? std::string("%%") : std::string(1, c);
    if (numberFields("##value", &value, 1, {.format = format, .range = range, .span = range.hi - range.lo})) {
        view.value = value;
        view.channel = known.name; // a value is one of a parameter, whatever the layers show
    }
    if (ImGui::IsItemHovered()) tooltip("Value that samples of pieces reach; Ctrl+click to type it");
}

/// Offers shares of the box, as volumes.
void chooseLeast(ToolRow& tools, const volume::DatasetInfo& info, PiecesView& view) {
    if (!tools.next(em() * 9)) return;
    const glm::dvec3 size = info.bounds.size();
    const double box = size.x * size.y * size.z;
    const auto textFor = [&](double volume) {
        return volume > 0 ? "from " + volumeText(info, volume) : std::string("of any size");
    };
    ImGui::SetNextItemWidth(em() * 9);
    if (ImGui::BeginCombo("##least", textFor(view.leastVolume).c_str())) {
        for (const double share : {0.0, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2})
            if (ImGui::Selectable(textFor(share * box).c_str(), view.leastVolume == share * box))
                view.leastVolume = share * box;
        ImGui::EndCombo();
    } else if (ImGui::IsItemHovered()) {
        tooltip("Least volume of a piece when it is largest; how many smaller ones are left out is said");
    }
}

/// The piece under the mouse: the nearest one of the time nearest to it.
std::optional<std::size_t> pieceUnderMouse(const volume::PieceGraph& graph, const std::vector<glm::dvec2>& places,
                                           const PlotFrame& frame, double least) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    std::optional<std::size_t> found;
    double nearest = least;
    for (std::size_t i = 0; i < graph.pieces.size(); ++i) {
        const ImVec2 at = frame.pixel(places[i].x, places[i].y);
        const double away = std::hypot(double(at.x - mouse.x), double(at.y - mouse.y));
        if (away > nearest) continue;
        nearest = away;
        found = i;
    }
    return found;
}

/// The middle of the distance between times in pixels, within which a point of a line is found.
double reachOf(const volume::DatasetInfo& info, const PlotFrame& frame) {
    const double steps = double(std::max<std::size_t>(1, info.times.size() - 1));
    return std::max(double(em()) * 0.9, double(frame.width()) / steps * 0.75);
}

void takeTime(ViewContext& context, const volume::DatasetInfo& info, const Plot& plot, double share) {
    const double at = plot.x.range.lo + share * (plot.x.range.hi - plot.x.range.lo);
    context.session.time = info.times[std::size_t(info.nearestTime(at))];
    context.session.animation.playing = false;
    context.interacting = true;
}

void drawGraph(ViewContext& context, PiecesCache& cache, const volume::PieceGraph& graph,
               const PiecesQuestion& question, bool exact, bool events) {
    const volume::DatasetInfo& info = context.numbers->info();
    PiecesLook look{.events = events, .dark = darkTheme(), .chosen = chosenPiece(context.session, info, question)};
    if (context.decoration.cursor) look.time = context.session.time;
    Plot plot = piecesPlot(info, graph, question, look, cache.layout);
    plot.title.clear(); // the tools say it
    const std::optional<PlotColumn> column = placePlots({plot});
    if (!column) return;
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const PlotFrame& frame = column->frames.front();
    drawPlot(draw, plot, frame, column->titled, column->left);
    drawPlotBottom(draw, plot, *column);
    if (!column->hovered || !context.takesInput()) return;
    const std::vector<glm::dvec2>& places = cache.layout.places;
    const auto under = pieceUnderMouse(graph, places, frame, reachOf(info, frame));
    const bool pressed = ImGui::IsMouseClicked(ImGuiMouseButton_Left);
    if (pressed) cache.onPiece = under.has_value();
    if (under && !(column->taken && !cache.onPiece)) {
        const ImVec2 at = frame.pixel(places[*under].x, places[*under].y);
        draw.AddCircle(at, em() * 0.45f, plotColors().cursor, 24, em() * 0.13f);
        std::string text = pieceText(info, graph, question, *under);
        text += question.of == PiecesOf::Selected ? "\nClick: goes there"
                : exact                           ? "\nClick: goes there and selects it"
                                                  : "\nStill refined. Click: goes there";
        ImGui::SetTooltip("%s", text.c_str());
    }
    if (!column->taken) return;
    if (!cache.onPiece) return takeTime(context, info, plot, column->share);
    if (pressed && under) selectPiece(context.session, info, question, graph.pieces[*under], exact);
}

/// The graph on a page. On a small one, words give way to its lines: the note, the events with their names, then the
/// name of the parameter in the title.
VectorPage piecesPage(const volume::DatasetInfo& info, const volume::PieceGraph& graph, const PiecesQuestion& question,
                      const PiecesLook& look, const PageForm& form) {
    Plot plot = piecesPlot(info, graph, question, look, layOutPieces(info, graph));
    const auto small = [&](double lines) { return form.size.y > 0 && plotArea({plot}, 0, form).y < lines * form.text; };
    if (small(3)) plot.note.clear();
    if (form.legend && small(5)) plot.series.clear(); // their names take two lines or more
    if (small(2))
        plot.title = question.of == PiecesOf::Selected
                         ? "Pieces of the selection"
                         : "Pieces" + piecesName(info, question).substr(info.channel(question.channel).name.size());
    return plotPage({std::move(plot)}, 0, form);
}

} // namespace

void drawPiecesView(ViewContext& context, const std::string& pane, PiecesView& view) {
    if (!context.source) return drawHint("No data", "Follows connected pieces over time.");
    const volume::DatasetInfo& info = context.numbers->info();
    const std::optional<int> channel = resolveChannel(info, context.session, view.channel);
    if (!channel) return drawHint("No parameters", "Pieces are of samples that reach a value of a parameter.");
    PiecesCache& cache = cacheOf<PiecesCache>(context, pane);
    ToolRow tools(context);
    if (tools.next(em() * 8)) {
        ImGui::SetNextItemWidth(em() * 8);
        std::string name = info.channel(*channel).name;
        if (chooseChannel("##channel", &info, name)) {
            view.channel = name;
            view.value.reset();
        }
        if (ImGui::IsItemHovered()) tooltip("Parameter whose pieces are followed");
    }
    chooseSide(tools, context.session, view);
    choosePiecesValue(tools, info, *channel, view);
    chooseLeast(tools, info, view);
    if (view.of == PiecesOf::Selected && !context.session.selection.active())
        return drawHint("Nothing is selected", "Brush something in a plot: its pieces are followed over time.");
    const int shown = resolveChannel(info, context.session, view.channel).value_or(*channel);
    const PiecesQuestion question = piecesQuestion(context.session, info, view, shown);
    // A label of pieces that is added, as a click does, leaves the answer as it is.
    auto source = volume::underived(context.numbers);
    if (view.of == PiecesOf::Selected || std::size_t(shown) >= source->info().channels().size())
        source = context.numbers;
    const auto found = cache.answers.answer(
        context, source,
        {.key = "pieces " + pane,
         .title = "Pieces over time",
         .lowPriority = true,
         .firstLevel = firstPiecesLevel(source->grid(), info.times.size())},
        question,
        [](const std::shared_ptr<const volume::BrickSource>& data, const PiecesQuestion& asked, int level,
           const Progress& progress) { return readPieces(*data, asked, level, progress); },
        [](const PiecesQuestion& a, const PiecesQuestion& b) {
            return a.channel == b.channel && a.of == b.of && a.selection == b.selection;
        });
    if (!found) {
        const std::string failure = cache.answers.failure();
        return failure.empty() ? ImGui::TextDisabled("Searching...") : drawHint("No pieces", failure.c_str());
    }
    const PiecesQuestion& asked = found->query;
    const volume::PieceGraph& graph = found->result;
    if (asked == question)
        exportMenu(context, tools,
                   {.name = "pieces",
                    .figure =
                        [found, data = source, time = context.session.time, events = view.events](const PageForm& form,
                                                                                                  const Progress&) {
                            return piecesPage(data->info(), found->result, found->query,
                                              {.events = events, .dark = form.dark, .time = time}, form);
                        },
                    .table = [found, data = source](
                                 const Progress&) { return piecesTable(data->info(), found->result, found->query); },
                    .brushed = asked.of == PiecesOf::Selected},
                   false);
    drawNote(tools, piecesNote(info, graph, asked) + "; widths by volume");
    if (graph.pieces.empty()) {
        const std::string none = graph.leftOutTracks > 0
                                     ? piecesNote(info, graph, asked) + "."
                                     : "No sample at any time belongs to " + piecesName(info, asked) + ".";
        return drawHint("No pieces", none.c_str());
    }
    if (const std::string reason = tooManyPieces(graph); !reason.empty())
        return drawHint("Too many pieces", (reason + ".").c_str());
    if (cache.laidOut != found) {
        cache.layout = layOutPieces(info, graph);
        cache.laidOut = found;
    }
    drawGraph(context, cache, graph, asked, found->level == 0 && asked == question, view.events);
}

} // namespace tessera::app
