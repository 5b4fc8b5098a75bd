#include "app/pane/choose_times.h"
#include "app/pane/view_parts.h"
#include "app/plots/plot_view.h"
#include "app/queries/async_query.h"
#include "app/tools/brush_edit.h"
#include "app/tools/profile_line.h"
#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "app/ui/widgets.h"
#include "app/views/curves/profile_data.h"
#include "app/views/curves/section_view.h"
#include "vis/gl/plot_texture.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tessera::app {

namespace {

constexpr std::size_t kMostProfiles = 8; ///< where the user has not chosen
constexpr float kColorsGap = 0.5f;       ///< em: between a picture and its colours

struct ProfileCache : ViewCache {
    AsyncQuery<ProfileQuery, Profile> answers;
    std::shared_ptr<const Profile> pictured; ///< what the pictures show
    std::map<std::string, vis::TransferFunction> picturedWith;
    std::vector<vis::PlotTexture> pictures; ///< by channel
};

void drawToolbar(ViewContext& context, const std::shared_ptr<const Profile>& profile, ProfileView& view,
                 const std::vector<int>& shown) {
    Session& session = context.session;
    const volume::DatasetInfo& info = context.numbers->info();
    ToolRow tools(context);
    chooseChannels(tools, info, view.channels, shown);
    chooseOver(tools, view.over, info.times.size() > 1);
    if (view.over == ProfileOver::Line) chooseTimes(tools, info, view.times, session);
    if (view.over != ProfileOver::Time) {
        if (tools.next(buttonWidth("Corner at cross-hair"))) {
            if (ImGui::Button("Corner at cross-hair")) view.points.push_back(session.cursor);
            if (ImGui::IsItemHovered())
                tooltip(
                    "Add a corner of the line at the cross-hair, which you move by a double-click in the volume or by "
                    "dragging in a slice");
        }
        if (tools.next(buttonWidth("Axis"))) {
            if (ImGui::Button("Axis")) ImGui::OpenPopup("axis");
            if (ImGui::IsItemHovered()) tooltip("Use a straight line along an axis through the cross-hair");
            if (ImGui::BeginPopup("axis")) {
                for (int axis = 0; axis < 3; ++axis) {
                    const char name[] = {"xyz"[axis], 0};
                    if (!ImGui::MenuItem(name)) continue;
                    view.points = {session.cursor, session.cursor};
                    view.points[0][axis] = info.bounds.lo[axis];
                    view.points[1][axis] = info.bounds.hi[axis];
                }
                ImGui::EndPopup();
            }
        }
        if (tools.next(ImGui::GetFrameHeight()) &&
            iconButton(context, "clear", icons::kTrash,
                       "Remove the corners: the line runs through the cross-hair along the longest axis",
                       !view.points.empty()))
            view.points.clear();
    }
    const bool ofTimes = view.over == ProfileOver::Line && !view.times.empty(),
               atShown = view.over == ProfileOver::Line && !ofTimes;
    const std::string times = ofTimes ? chosenTimesText(info, view.times, session.time) : std::string();
    if (profile) {
        exportMenu(
            context, tools,
            {.name = "profile",
             .figure = [info, profile,
                        session](const PageForm& form,
                                 const Progress&) { return profileDrawing(info, session, *profile, form); },
             .table = [info, profile, session](const Progress&) { return profileTable(info, session, *profile); }},
            atShown, times.empty() ? std::string() : originText(context) + times);
    }
    drawOriginText(context, tools, originText(context, shown) + times, atShown);
    if (view.points.size() == 1 && view.over != ProfileOver::Time) drawNote(tools, "one more corner needed");
}

void updatePictures(vis::TexturesIn where, ProfileCache& cache, const Session& session, const volume::DatasetInfo& info,
                    const std::shared_ptr<const Profile>& profile) {
    if (cache.pictured == profile && cache.picturedWith == session.transfer) return;
    cache.pictured = profile;
    cache.picturedWith = session.transfer;
    cache.pictures.resize(profile->values.size());
    for (std::size_t c = 0; c < profile->values.size(); ++c)
        cache.pictures[c].upload(where,
                                 {static_cast<int>(profile->positions.size()), static_cast<int>(profile->times.size())},
                                 profileImage(info, session, *profile, c));
}

/// One parameter over distance and time.
void drawPicture(const vis::PlotTexture& picture, const std::vector<double>& times, const PlotFrame& frame) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    // A row of the picture reaches half way to the times before and after it, its first and last place to the edge.
    const auto rows = static_cast<float>(times.size());
    draw.PushClipRect(frame.min, frame.max, true);
    for (std::size_t t = 0; t < times.size(); ++t) {
        const double from = t > 0 ? (times[t - 1] + times[t]) / 2 : times.front();
        const double to = t + 1 < times.size() ? (times[t] + times[t + 1]) / 2 : times.back();
        const float v = 1 - (static_cast<float>(t) + 0.5f) / rows;
        draw.AddImage(textureId(picture.name()), {frame.min.x, frame.pixel(0, to).y},
                      {frame.max.x, frame.pixel(0, from).y}, {0, v}, {1, v});
    }
    draw.PopClipRect();
}

/// The colours of a picture at its right, with the unit between the ends where that has room.
void drawColors(const LegendEntry& entry, const PlotFrame& frame) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float left = frame.max.x + em() * kColorsGap;
    drawLegendColumn(draw, {left, frame.min.y}, frame.height(), entry);
    const std::string unit = prettyUnit(entry.unit);
    if (ImGui::CalcTextSize(unit.c_str()).x > frame.height() - 3 * ImGui::GetTextLineHeight()) return;
    addTextUpwards(draw, {left + em() * 1.5f, (frame.min.y + frame.max.y) / 2}, plotColors().faint, unit.c_str());
}

ProfileQuery profileQuery(const ProfileView& view, const Session& session, const volume::DatasetInfo& info,
                          const std::vector<int>& channels) {
    ProfileQuery query{.over = info.times.size() > 1 ? view.over : ProfileOver::Line,
                       .channels = channels,
                       .corners = profileCorners(view, session, info.bounds),
                       .samples = std::clamp(view.samples, 2, 4096),
                       .times = {}};
    if (query.over == ProfileOver::Line) query.times = chosenTimes(info, view.times, session.time);
    if (query.over == ProfileOver::Time) query.corners = {session.cursor}, query.samples = 1;
    return query;
}

/// The plots of a profile, one under the other: a curve of each parameter, or a picture over distance and time.
class ProfilePlots {
public:
    ProfilePlots(ViewContext& context, ProfileCache& cache, const std::shared_ptr<const Profile>& profile)
        : context_(context), cache_(cache), session_(context.session), info_(context.numbers->info()),
          profile_(profile), over_(profile->query.over), plots_(profilePlots(info_, session_, *profile, darkTheme())) {}

    void draw() {
        const std::optional<PlotColumn> column = placePlots(plots_, colorsRoom());
        if (!column) return;
        const std::optional<std::size_t> place = marked(*column);
        if (column->taken && place) takePlace(*place, *column);
        if (context_.decoration.cursor) markPlots(plots_, info_, session_, *profile_, place);
        if (pictures()) updatePictures(context_.renderer.textures(), cache_, session_, info_, profile_);
        ImDrawList& draw = *ImGui::GetWindowDrawList();
        for (std::size_t c = 0; c < plots_.size(); ++c) {
            const PlotFrame& frame = column->frames[c];
            if (pictures()) drawPicture(cache_.pictures[c], profile_->times, frame);
            drawPlot(draw, plots_[c], frame, column->titled, column->left);
            if (column->beside > 0) drawColors(legend(c), frame);
        }
        drawPlotBottom(draw, plots_.back(), *column);
    }

private:
    bool overTime() const { return over_ == ProfileOver::Time; }
    bool pictures() const { return over_ == ProfileOver::LineAndTime; }
    LegendEntry legend(std::size_t c) const { return legendOf(session_, info_, profile_->query.channels[c]); }
    /// Pixels that the colours of the pictures take beside them; 0 for curves.
    float colorsRoom() const {
        float widest = 0;
        for (std::size_t c = 0; c < plots_.size() && pictures() && context_.decoration.legend; ++c)
            widest = std::max(widest, legendColumnWidth(legend(c)));
        return widest > 0 ? widest + em() * kColorsGap : 0;
    }

    /// What is under the mouse, else what the linked time or cursor is at.
    std::optional<std::size_t> marked(const PlotColumn& column) const {
        if (!column.hovered) return markedPlace(info_, session_, *profile_);
        if (overTime())
            return static_cast<std::size_t>(
                info_.nearestTime(std::lerp(info_.times.front(), info_.times.back(), column.share)));
        const std::vector<double> across = lineAxis(session_, info_, *profile_).values;
        const bool backwards = across.front() > across.back(); // from a later time to an earlier one
        return static_cast<std::size_t>(
            std::lround((backwards ? 1 - column.share : column.share) * static_cast<double>(across.size() - 1)));
    }

    /// A click or drag takes the cursor or the time there; in a picture both.
    void takePlace(std::size_t place, const PlotColumn& column) {
        if (over_ != ProfileOver::Line) session_.animation.playing = false;
        if (overTime())
            session_.time = profile_->times[place];
        else
            session_.cursor = profile_->positions[place];
        const ImVec2 mouse = ImGui::GetIO().MousePos;
        for (const PlotFrame& frame : column.frames)
            if (pictures() && frame.contains(mouse))
                session_.time = info_.times[static_cast<std::size_t>(info_.nearestTime(frame.data(mouse).y))];
        context_.interacting = true;
    }

    ViewContext& context_;
    ProfileCache& cache_;
    Session& session_;
    const volume::DatasetInfo& info_;
    std::shared_ptr<const Profile> profile_;
    ProfileOver over_;
    std::vector<Plot> plots_;
};

} // namespace

void drawProfileView(ViewContext& context, const std::string& pane, ProfileView& view) {
    if (!context.source) {
        drawHint("No data", "Shows parameters along a line in space.");
        return;
    }
    if (view.over == ProfileOver::Sections) return drawSections(context, pane, view);
    const volume::DatasetInfo& info = context.numbers->info();
    ProfileCache& cache = cacheOf<ProfileCache>(context, pane);
    const std::vector<int> shown = chosenChannels(info, view.channels, kMostProfiles);
    if (shown.empty()) return drawHint("No parameters", "This data set has only labels.");
    const ProfileQuery query = profileQuery(view, context.session, info, shown);
    const auto profile = cache.answers.get(
        context, context.numbers, {.key = "profile " + pane, .title = "Line profile", .quiet = true}, query,
        [](const auto& source, const ProfileQuery& asked, int, const Progress& progress) {
            return readProfile(*source, asked, progress);
        },
        [](const ProfileQuery& a, const ProfileQuery& b) { return a.over == b.over && a.channels == b.channels; });
    const bool usable =
        profile && (query.over == ProfileOver::Time || (profile->distance.size() > 1 && profile->distance.back() > 0));
    drawToolbar(context, usable ? profile : nullptr, view, shown);
    if (usable) return ProfilePlots(context, cache, profile).draw();
    if (const std::string failure = cache.answers.failure(); !failure.empty())
        return drawHint("No values", failure.c_str());
    if (!profile) return ImGui::TextDisabled("Reading...");
    drawHint("The line has no length", "Place a corner, move the cross-hair, and place another.");
}

} // namespace tessera::app
