#include "app/views/volume/callouts_beside.h"

#include "app/callouts/callout_menu.h"
#include "app/pane/oblique_plane.h"
#include "app/pane/view_parts.h"
#include "app/tools/lens_outline.h"
#include "app/ui/keys.h"
#include "app/ui/widgets.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tessera::app {

namespace {

constexpr float kEnlarged = 1.7f; ///< under the mouse
constexpr const char* kCalloutPopup = "callout";

ImVec2 toPixel(glm::vec2 at) {
    return {at.x, at.y};
}

/// The colour of lines to a placeholder.
ImU32 placeColor(const CalloutPlace& place, float alpha) {
    return place.normal ? plotColors().text : lensColor(place.color, alpha);
}

} // namespace

CalloutsBeside::CalloutsBeside(ViewContext& context, CalloutsCache& cache, bool shown, const PictureBox& picture,
                               std::string pane)
    : context_(context), cache_(cache), wanted_(shown), picture_(picture), pane_(std::move(pane)) {}

void CalloutsBeside::place(const SpaceFrame& space, bool moving) {
    Session& session = context_.session;
    shown_.clear();
    beyond_ = 0;
    layout_ = {};
    while (cache_.states.size() < session.callouts.size()) cache_.states.push_back(std::make_unique<CalloutState>());
    if (!wanted_) return;
    std::vector<glm::vec2> anchors;
    for (std::size_t i = 0; i < session.callouts.size(); ++i) {
        if (!session.callouts[i].enabled) continue;
        auto found = calloutPlace(session, context_.source->info(), session.callouts[i]);
        if (!found) continue;
        if (shown_.size() == kMostCallouts) {
            ++beyond_;
            continue;
        }
        const auto at = space.pixel(space.world.toPhysical(found->center));
        const ImVec2 middle{picture_.min.x + picture_.size.x / 2, picture_.min.y + picture_.size.y / 2};
        Shown own{.index = i, .place = std::move(*found), .seen = at.has_value()};
        own.anchor = {at.value_or(middle).x, at.value_or(middle).y};
        anchors.push_back(own.anchor);
        shown_.push_back(std::move(own));
    }
    const CalloutRoom room =
        calloutRoom({picture_.min.x, picture_.min.y}, {picture_.max().x, picture_.max().y}, cache_.taken, em());
    std::vector<std::size_t> indices;
    for (const Shown& own : shown_) indices.push_back(own.index);
    if (indices != cache_.shown) cache_.slots.clear();
    cache_.shown = indices;
    layout_ = placeCallouts(anchors, room, cache_.slots, moving);
    cache_.slots = layout_.slots;
}

PictureBox CalloutsBeside::boxOf(std::size_t at) const {
    const CalloutBox& box = layout_.boxes[at];
    PictureBox out{toPixel(box.min), {box.max.x - box.min.x, box.max.y - box.min.y}};
    if (int(shown_[at].index) != cache_.held) return out;
    const ImVec2 size{std::round(std::min(out.size.x * kEnlarged, picture_.size.x * 0.6f)),
                      std::round(std::min(out.size.y * kEnlarged, picture_.size.y - em()))};
    if (layout_.slots[at].right) out.min.x -= size.x - out.size.x;
    out.min.y = std::clamp(std::round(out.min.y - (size.y - out.size.y) / 2), picture_.min.y + em() * 0.5f,
                           std::max(picture_.min.y + em() * 0.5f, picture_.max().y - em() * 0.5f - size.y));
    out.size = size;
    return out;
}

PictureBox CalloutsBeside::innerOf(const PictureBox& box) const {
    const float title = std::round(em() * 1.4f);
    return {{box.min.x + 1, box.min.y + title},
            {std::floor(box.size.x - 2), std::floor(std::max(0.0f, box.size.y - title - 1))}};
}

CalloutPart CalloutsBeside::partOf(std::size_t at) const {
    const Shown& own = shown_[at];
    return {.callout = context_.session.callouts[own.index],
            .place = own.place,
            .state = *cache_.states[own.index],
            .key = pane_ + " callout " + std::to_string(own.index),
            .inner = innerOf(boxOf(at)),
            .share = 1.0 / 3 / double(std::max<std::size_t>(1, layout_.boxes.size())) / std::max(1, context_.volumes)};
}

void CalloutsBeside::hold(bool free) {
    if (!context_.takesInput()) {
        cache_.held = -1;
        return;
    }
    const bool pressed = ImGui::IsMouseDown(ImGuiMouseButton_Left) || ImGui::IsPopupOpen(kCalloutPopup);
    if (pressed && cache_.held >= 0) return;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const bool over = free && !pressed && ImGui::IsWindowHovered(ImGuiHoveredFlags_AllowWhenBlockedByActiveItem);
    int next = -1;
    for (std::size_t i = 0; i < layout_.boxes.size(); ++i) {
        const int index = int(shown_[i].index);
        if (over && boxOf(i).contains(mouse) && (next < 0 || index == cache_.held)) next = index;
    }
    cache_.held = next;
}

bool CalloutsBeside::takeOne(std::size_t at) {
    ImGui::PushID(int(shown_[at].index));
    const PictureBox box = boxOf(at);
    const bool moved = useCallout(context_, partOf(at));
    ImGui::SetCursorScreenPos(box.min);
    mouseArea("box", box.size,
              ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle |
                  ImGuiButtonFlags_MouseButtonRight); // nothing below is meant
    ImGui::PopID();
    return moved;
}

bool CalloutsBeside::take(const SpaceFrame& space, bool free) {
    if (context_.session.callouts.empty()) return false;
    place(space, true);
    hold(free);
    if (!context_.takesInput()) return false;
    const ImVec2 before = ImGui::GetCursorScreenPos();
    bool moved = false;
    for (const bool held : {true, false}) // the enlarged one lies over the others
        for (std::size_t i = 0; i < layout_.boxes.size(); ++i)
            if ((int(shown_[i].index) == cache_.held) == held) moved = takeOne(i) || moved;
    if (cache_.held >= 0 && free && ImGui::IsMouseClicked(ImGuiMouseButton_Right)) ImGui::OpenPopup(kCalloutPopup);
    if (ImGui::BeginPopup(kCalloutPopup)) {
        if (escapePressed()) ImGui::CloseCurrentPopup();
        std::vector<Callout>& all = context_.session.callouts;
        const std::size_t own = std::size_t(cache_.held);
        if (cache_.held >= 0 && own < all.size() && drawCalloutMenu(context_, own)) {
            all.erase(all.begin() + std::ptrdiff_t(own));
            cache_.states.erase(cache_.states.begin() + std::ptrdiff_t(own));
            cache_.held = -1;
        }
        ImGui::EndPopup();
    }
    ImGui::SetCursorScreenPos(before);
    return moved;
}

/// The part of a plane in the box of the data.
void CalloutsBeside::drawFrame(ImDrawList& draw, const SpaceFrame& space, const Shown& shown) const {
    const volume::DatasetInfo& info = context_.source->info();
    std::vector<ImVec2> corners;
    for (const glm::dvec3& corner :
         planeSection({*shown.place.normal, space.world.axes.toSheet(context_.session.cursor)}, info.bounds)) {
        const auto at = space.pixel(space.world.axes.toSpace(corner));
        if (!at) return;
        corners.push_back(*at);
    }
    if (corners.size() < 3) return;
    const ImU32 color = plotColors().text;
    draw.AddConvexPolyFilled(corners.data(), int(corners.size()), (color & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, 22));
    draw.AddPolyline(corners.data(), int(corners.size()), color, ImDrawFlags_Closed, std::max(1.0f, em() * 0.09f));
}

void CalloutsBeside::drawLine(ImDrawList& draw, const SpaceFrame& space, std::size_t at) const {
    const Shown& own = shown_[at];
    if (!own.seen) return;
    const glm::vec2 port = layout_.port(at), way = own.anchor - port;
    float end = 1;
    if (own.place.ball) { // up to its outline
        const glm::dvec3 right = glm::conjugate(glm::dquat(context_.session.camera.orientation)) * glm::dvec3(1, 0, 0);
        const auto rim = space.pixel(space.world.toPhysical(own.place.center + right * own.place.half.x));
        const float radius = rim ? std::hypot(rim->x - own.anchor.x, rim->y - own.anchor.y) : 0;
        end = std::max(0.0f, 1 - radius / std::max(1.0f, glm::length(way)));
    }
    const glm::vec2 to = port + way * end;
    const float width = std::max(1.0f, em() * 0.1f);
    const ImU32 color = placeColor(own.place, 1);
    draw.AddLine(toPixel(port), toPixel(to), plotColors().backdrop, width + 2);
    draw.AddLine(toPixel(port), toPixel(to), color, width);
    draw.AddCircleFilled(toPixel(to), std::max(2.0f, em() * 0.2f), color);
}

void CalloutsBeside::drawBox(ImDrawList& draw, std::size_t at, const vis::Scene& view, bool moving) {
    const Shown& own = shown_[at];
    const PictureBox box = boxOf(at);
    const float corner = em() * 0.2f;
    const ImVec4 ground = ImGui::GetStyleColorVec4(ImGuiCol_WindowBg);
    draw.AddRectFilled(box.min, box.max(), ImGui::ColorConvertFloat4ToU32({ground.x, ground.y, ground.z, 1}), corner);
    draw.PushClipRect(box.min, box.max(), true);
    const CalloutPart part = partOf(at);
    {
        const ShownCallout shown(context_.session, part.callout);
        const std::string title = calloutTitle(context_, part.callout, own.place, box.size.x - em());
        draw.AddText({box.min.x + em() * 0.5f, box.min.y + em() * 0.2f}, plotColors().text, title.c_str());
    }
    drawCallout(context_, part, view, moving);
    draw.PopClipRect();
    draw.AddRect(box.min, box.max(), placeColor(own.place, 0.9f), corner, 0, std::max(1.0f, em() * 0.1f));
}

void CalloutsBeside::sayHidden(ImDrawList& draw) const {
    const std::size_t hidden = shown_.size() + beyond_ - layout_.boxes.size();
    if (hidden == 0) return;
    const std::string text =
        std::to_string(hidden) + (hidden == 1 ? " callout has" : " callouts have") + " no room here";
    const float half = std::min(picture_.size.x - em(), ImGui::CalcTextSize(text.c_str()).x) / 2;
    const float middle = picture_.min.x + picture_.size.x / 2;
    float bottom = picture_.max().y - em() * 0.5f; // above the legends and what else stands there
    for (const CalloutBox& other : cache_.taken)
        if (other.min.x < middle + half && other.max.x > middle - half &&
            other.max.y > picture_.min.y + picture_.size.y / 2)
            bottom = std::min(bottom, other.min.y - em() * 0.2f);
    addFittedWithBackdrop(draw, {middle, bottom}, {0.5f, 1}, plotColors().faint, text, picture_.size.x - em());
}

void CalloutsBeside::reserve(const SpaceFrame& space, bool moving, Rectangles& taken) {
    if (context_.session.callouts.empty()) return;
    cache_.taken.clear();
    for (const auto& [lo, hi] : taken) cache_.taken.push_back({{lo.x, lo.y}, {hi.x, hi.y}});
    place(space, moving);
    for (std::size_t i = 0; i < layout_.boxes.size(); ++i) taken.push_back({boxOf(i).min, boxOf(i).max()});
}

void CalloutsBeside::draw(const SpaceFrame& space, const vis::Scene& view, bool moving) {
    if (context_.session.callouts.empty()) return;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    for (std::size_t i = 0; i < layout_.boxes.size(); ++i) {
        const auto same = [&](const Shown& other) { return other.place == shown_[i].place; };
        const auto end = shown_.begin() + std::ptrdiff_t(i);
        if (shown_[i].place.normal && std::none_of(shown_.begin(), end, same)) drawFrame(list, space, shown_[i]);
    }
    for (std::size_t i = 0; i < layout_.boxes.size(); ++i) drawLine(list, space, i);
    for (const bool held : {false, true})
        for (std::size_t i = 0; i < layout_.boxes.size(); ++i) {
            if ((int(shown_[i].index) == cache_.held) != held) continue;
            drawBox(list, i, view, moving);
        }
    sayHidden(list);
}

} // namespace tessera::app
