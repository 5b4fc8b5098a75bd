#include "app/pane/figure.h"
#include "app/pane/view_parts.h"
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
constexpr float kBeside = 0.5f;          ///< em: between a picture and its colours

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
    if (profile) {
        exportMenu(context, tools,
                   {.name = "profile",
                    .figure = [info, profile, session](
                                  const PageForm&, const Progress&) { return profileDrawing(info, session, *profile); },
                    .csv = [info, profile, session](const Progress&) { return profileCsv(info, session, *profile); }});
    }
    drawOrigin(context, tools, shown, view.over == ProfileOver::Line);
    if (view.points.size() == 1 && view.over != ProfileOver::Time) drawNote(tools, "one more corner needed");
}

/// What the plots share: the axis to the right and what is marked on it.
struct Across {
    std::string title, unit;
    std::vector<double> values; ///< of the places or times, as shown
    Range range;
    std::optional<std::size_t> marked; ///< element of Profile::across()
};

/// One parameter as a curve.
void drawCurve(const std::string& title, Range range, const Profile& profile, std::size_t c, const PlotFrame& frame,
               const Across& across) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const PlotColors colors = plotColors();
    const std::vector<double>& values = profile.values[c];
    std::vector<std::vector<ImVec2>> runs(1);
    std::vector<ImVec2> line;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (std::isnan(values[i])) {
            runs.emplace_back();
            continue;
        }
        line.push_back(frame.pixel(across.values[i], values[i]));
        runs.back().push_back(line.back());
    }
    const std::optional<std::size_t> marked = across.marked;
    std::string text = title;
    if (marked) text += "  " + formatNumber(values[*marked], (range.hi - range.lo) / 1000);
    const ImVec2 size{std::min(ImGui::CalcTextSize(text.c_str()).x, frame.width() - em()), em()};
    const ImVec2 pivot = freeCorner(frame, {size.x + em() * 0.8f, size.y + em() * 0.4f}, line);
    const auto inset = [](float lo, float hi, float share, float by) { return share > 0 ? hi - by : lo + by; };
    addFittedWithBackdrop(
        draw,
        {inset(frame.min.x, frame.max.x, pivot.x, em() * 0.4f), inset(frame.min.y, frame.max.y, pivot.y, em() * 0.2f)},
        pivot, colors.text, text, frame.width() - em());
    // Over the title: a low plot has no corner without the curve.
    draw.PushClipRect(frame.min, frame.max, true);
    for (const std::vector<ImVec2>& run : runs)
        if (run.size() > 1)
            draw.AddPolyline(run.data(), static_cast<int>(run.size()), colors.focus, 0, std::max(1.2f, em() * 0.11f));
        else if (run.size() == 1)
            draw.AddCircleFilled(run.front(), em() * 0.12f, colors.focus);
    if (marked) drawCrosshair(draw, frame, across.values[*marked], values[*marked]);
    draw.PopClipRect();
    draw.AddRect(frame.min, frame.max, colors.frame);
    drawAxis(draw, frame, AxisSide::Left, "", "", frame.min.y - em() * 0.3f, frame.max.y + em() * 0.3f);
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
void drawPicture(const Session& session, const std::string& title, const vis::PlotTexture& picture,
                 const Profile& profile, const PlotFrame& frame, const Across& across) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const PlotColors colors = plotColors();
    // A row of the picture reaches half way to the times before and after it, its first and last place to the edge.
    const std::vector<double>& times = profile.times;
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
    draw.PushClipRect(frame.min, frame.max, true);
    drawCrosshair(draw, frame, across.marked ? across.values[*across.marked] : std::nan(""), session.time, true);
    draw.PopClipRect();
    draw.AddRect(frame.min, frame.max, colors.frame);
    drawAxis(draw, frame, AxisSide::Left, "", "", frame.min.y - em() * 0.3f, frame.max.y + em() * 0.3f);
    addFittedWithBackdrop(draw, {frame.min.x + em() * 0.4f, frame.min.y + em() * 0.2f}, {0, 0}, colors.text, title,
                          frame.width() - em());
}

/// The colours of a picture at its right, with the unit between the ends where that has room.
void drawColors(const LegendEntry& entry, const PlotFrame& frame) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float left = frame.max.x + em() * kBeside;
    drawLegendColumn(draw, {left, frame.min.y}, frame.height(), entry);
    const std::string unit = prettyUnit(entry.unit);
    if (ImGui::CalcTextSize(unit.c_str()).x > frame.height() - 3 * ImGui::GetTextLineHeight()) return;
    addTextUpwards(draw, {left + em() * 1.5f, (frame.min.y + frame.max.y) / 2}, plotColors().faint, unit.c_str());
}

/// The place nearest to the linked cursor, where that lies near the line.
std::optional<std::size_t> placeAtCursor(const Profile& profile, glm::dvec3 cursor) {
    std::optional<std::size_t> place;
    double nearest = profile.distance.back() / static_cast<double>(profile.distance.size());
    for (std::size_t i = 0; i < profile.positions.size(); ++i)
        if (const double away = glm::distance(profile.positions[i], cursor); away <= nearest) {
            nearest = away;
            place = i;
        }
    return place;
}

ProfileQuery profileQuery(const ProfileView& view, const Session& session, const volume::DatasetInfo& info,
                          const std::vector<int>& channels) {
    ProfileQuery query{.over = info.times.size() > 1 ? view.over : ProfileOver::Line,
                       .channels = channels,
                       .corners = profileCorners(view, session, info.bounds),
                       .samples = std::clamp(view.samples, 2, 4096),
                       .time = {}};
    if (query.over == ProfileOver::Line) query.time = volume::timesAround(info.times, session.time);
    if (query.over == ProfileOver::Time) query.corners = {session.cursor}, query.samples = 1;
    return query;
}

/// The plots of a profile, one under the other: a curve of each parameter, or a picture over distance and time.
class ProfilePlots {
public:
    ProfilePlots(ViewContext& context, ProfileCache& cache, const std::shared_ptr<const Profile>& profile,
                 ProfileOver over)
        : context_(context), cache_(cache), session_(context.session), info_(context.numbers->info()),
          profile_(profile), over_(over), times_{info_.times.front(), info_.times.back()} {
        const LineAxis along = lineAxis(session_, info_, *profile);
        const auto [least, most] = std::ranges::minmax(along.values);
        if (overTime())
            across_ = {
                .title = timeWord(info_), .unit = info_.timeUnit, .values = info_.times, .range = times_, .marked = {}};
        else
            across_ = {
                .title = along.title, .unit = along.unit, .values = along.values, .range = {least, most}, .marked = {}};
    }

    void draw() {
        const ImVec2 origin = ImGui::GetCursorScreenPos();
        float left = pictures() ? axisRoom(AxisSide::Left, times_, TitlePlace::Nowhere) : 0;
        for (std::size_t c = 0; c < profile_->values.size() && !pictures(); ++c)
            left = std::max(left, axisRoom(AxisSide::Left, paddedRange(rangeOf(c), 0.06), TitlePlace::Nowhere));
        const ColumnHeights heights = columnHeights(ImGui::GetContentRegionAvail().y, profile_->values.size());
        const ImVec2 room{ImGui::GetContentRegionAvail().x, heightAtLeast(heights.all)};
        const float height = heights.each;
        if (room.x - left < em() * 4) return drawHint("Not enough room", "Enlarge the pane.");
        const float x0 = origin.x + left;
        float x1 = origin.x + room.x - em() * 0.6f;
        const float colors = colorsRoom();
        const bool explained = colors > 0 && x1 - x0 - colors > em() * 8;
        if (explained) x1 -= colors;
        ImGui::SetCursorScreenPos({x0, origin.y});
        mouseArea("plots", {x1 - x0, room.y - heights.bottom});
        const bool taken = ImGui::IsItemActive();
        const double share = std::clamp(double((ImGui::GetIO().MousePos.x - x0) / (x1 - x0)), 0.0, 1.0);
        across_.marked = marked(ImGui::IsItemHovered() || taken, share);
        if (taken && across_.marked) takePlace(*across_.marked);
        if (pictures()) updatePictures(context_.renderer.textures(), cache_, session_, info_, profile_);
        for (std::size_t c = 0; c < profile_->values.size(); ++c) {
            const float top = origin.y + em() * 0.2f + height * static_cast<float>(c);
            const PlotFrame frame{{x0, std::round(top)},
                                  {x1, std::round(top + height - em() * 0.4f)},
                                  across_.range,
                                  pictures() ? times_ : paddedRange(rangeOf(c), 0.06)};
            drawOne(c, frame, taken);
            if (explained) drawColors(legend(c), frame);
            if (c + 1 == profile_->values.size())
                drawAxis(*ImGui::GetWindowDrawList(), frame, AxisSide::Bottom, across_.title, across_.unit, origin.x,
                         origin.x + room.x, {.inlineTitle = !heights.titled});
        }
    }

private:
    bool overTime() const { return over_ == ProfileOver::Time; }
    bool pictures() const { return over_ == ProfileOver::LineAndTime; }
    const volume::Channel& channel(std::size_t c) const {
        return channels_[static_cast<std::size_t>(profile_->query.channels[c])];
    }
    LegendEntry legend(std::size_t c) const { return legendOf(session_, info_, profile_->query.channels[c]); }
    /// Pixels that the colours of the pictures take beside them; 0 for curves.
    float colorsRoom() const {
        float widest = 0;
        for (std::size_t c = 0; c < profile_->values.size() && pictures() && context_.decoration.legend; ++c)
            widest = std::max(widest, legendColumnWidth(legend(c)));
        return widest > 0 ? widest + em() * kBeside : 0;
    }
    Range rangeOf(std::size_t c) const { return info_.channelRange(channel(c)); }

    /// What is under the mouse, else what the linked time or cursor is at; `share`: of the width.
    std::optional<std::size_t> marked(bool underMouse, double share) const {
        if (overTime())
            return static_cast<std::size_t>(
                info_.nearestTime(underMouse ? times_.lo + (times_.hi - times_.lo) * share : session_.time));
        if (!underMouse) return placeAtCursor(*profile_, session_.cursor);
        const auto last = static_cast<double>(profile_->across().size() - 1);
        const bool backwards = across_.values.front() > across_.values.back(); // from a later time to an earlier one
        return static_cast<std::size_t>(std::lround((backwards ? 1 - share : share) * last));
    }

    /// A click or drag takes the cursor or the time there.
    void takePlace(std::size_t place) {
        if (over_ != ProfileOver::Line) session_.animation.playing = false;
        if (overTime())
            session_.time = profile_->times[place];
        else
            session_.cursor = profile_->positions[place];
        context_.interacting = true;
    }

    void drawOne(std::size_t c, const PlotFrame& frame, bool taken) {
        const std::string title = titleWithUnit(channel(c).name, channel(c).unit);
        if (!pictures()) return drawCurve(title, rangeOf(c), *profile_, c, frame, across_);
        const ImVec2 mouse = ImGui::GetIO().MousePos;
        if (taken && frame.contains(mouse))
            session_.time = info_.times[static_cast<std::size_t>(info_.nearestTime(frame.data(mouse).y))];
        drawPicture(session_, title + ", up: " + timeTitle(info_), cache_.pictures[c], *profile_, frame, across_);
    }

    ViewContext& context_;
    ProfileCache& cache_;
    Session& session_;
    const volume::DatasetInfo& info_;
    std::shared_ptr<const Profile> profile_;
    ProfileOver over_;
    Range times_;
    Across across_;
    std::vector<volume::Channel> channels_ = info_.channels();
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
    if (usable) return ProfilePlots(context, cache, profile, query.over).draw();
    if (const std::string failure = cache.answers.failure(); !failure.empty())
        return drawHint("No values", failure.c_str());
    if (!profile) return ImGui::TextDisabled("Reading...");
    drawHint("The line has no length", "Place a corner, move the cross-hair, and place another.");
}

} // namespace tessera::app
