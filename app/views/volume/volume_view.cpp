#include "app/edits/compare_files.h"
#include "app/pane/axes3d.h"
#include "app/pane/corner_legends.h"
#include "app/pane/inner_view.h"
#include "app/pane/scale_bar.h"
#include "app/pane/shown_plane.h"
#include "app/pane/view_parts.h"
#include "app/queries/readout.h"
#include "app/queries/scene_query.h"
#include "app/session/shown_scene.h"
#include "app/tools/brush_list.h"
#include "app/tools/camera_controller.h"
#include "app/tools/lens_edit.h"
#include "app/tools/lens_outline.h"
#include "app/tools/profile_line.h"
#include "app/tools/space_handles.h"
#include "app/ui/ticks.h"
#include "app/ui/time_text.h"
#include "app/ui/widgets.h"
#include "app/views/volume/callouts_beside.h"
#include "app/views/volume/ink_on_paper.h"
#include "app/views/volume/link_control.h"
#include "app/views/volume/plane_in_space.h"
#include "app/views/volume/probe_marks.h"
#include "app/views/volume/space_beside.h"
#include "app/views/volume/stereo_eyes.h"
#include "app/views/volume/upper_texts.h"
#include "app/views/volume/volume_menu.h"
#include "volume/import/files/upright.h"

#include <algorithm>
#include <cmath>

namespace tessera::app {

namespace {

struct VolumeCache : ViewCache {
    EyePictures eyes;
    AsyncScene scene;
    CalloutsCache callouts;
    CameraController hand;
    LensDrag lens;
    HandleDrag handles;
    // Where they stay while something moves.
    LegendPlace legend;
    TriadCorner triad = TriadCorner::BottomLeft;
};

/// Of a view of the data in space beside a plane whose times run along an axis.
struct SpaceCache : ViewCache {
    std::unique_ptr<vis::Renderer> renderer;
    std::map<std::string, std::unique_ptr<ViewCache>> caches; // gone before the renderer
    int renderers() const override { return renderer ? 1 : 0; }
};

/// One frame of a picture of the scene in a pane.
class SpacePicture {
public:
    SpacePicture(ViewContext& context, VolumeCache& cache, VolumeView& view, PictureBox picture,
                 const std::string& pane)
        : context_(context), cache_(cache), view_(view), picture_(picture), session_(context.session),
          shown_(context.decoration), info_(context.source->info()), world_(vis::worldFrame(info_, session_.stretch)),
          triad_(triadRadius(picture.size)), triadAt_(triadMiddle(picture.min, picture.max(), cache.triad, triad_)),
          hasTriad_(view.showGizmo && picture.size.x > em() * 13 && picture.size.y > em() * 9),
          chain_(context, view, picture), pane_(pane),
          callouts_(context, cache.callouts, view.showCallouts && view.stereo.kind != vis::StereoKind::SideBySide,
                    picture, pane) {}

    void draw() {
        const bool moving = useHands();
        vis::FrameRequest request;
        request.size = {picture_.size.x, picture_.size.y};
        request.moving = (moving || context_.interacting || plays()) && !context_.headless;
        request.wait = context_.headless;
        vis::Scene scene = cache_.scene.get(context_, pane_, request.moving);
        // In motion a third of the frame time is left to other views.
        const double all = double(scene.render.limits.frameTime) * (request.moving ? 2.0 / 3 : 1);
        request.budgetMs = all / std::max(context_.volumes, 1);
        scene.showBox = view_.showBox && shown_.box && framed();
        const RenderedEyes eyes = renderEyes(context_, cache_.eyes, scene, request, view_.stereo);

        const InkOnPaper ink(scene);
        scene_ = &scene;
        list_ = ImGui::GetWindowDrawList();
        if (view_.stereo.kind != vis::StereoKind::SideBySide) {
            drawOver(eyes.textures[0], session_.camera, eyes.status, request.moving);
        } else {
            const PictureBox whole = picture_;
            for (const vis::Eye eye : {vis::Eye::Left, vis::Eye::Right}) {
                picture_ = halfPicture(whole, view_.stereo, eye);
                taken_.clear();
                legendLeft_.reset();
                drawOver(eyes.textures[std::size_t(eye)], vis::eyeCamera(session_.camera, view_.stereo, eye),
                         eyes.status, request.moving);
            }
        }
    }

private:
    /// A picture and what is drawn over it, as a camera sees it.
    void drawOver(vis::TextureName texture, const vis::Camera& camera, const vis::FrameStatus& status, bool moving) {
        list_->PushClipRect(picture_.min, max(), true);
        upperLines_ = 0;
        addPicture(*list_, texture, picture_.min, max());
        const SpaceFrame space = spaceFrame(picture_.min, max(), camera, info_, session_.stretch);
        drawObjects(space);
        if (!moving) placeCorners(space);
        const AxisLabels labels = axisLabels(session_, info_);
        if (const auto chain = chain_.draw(*list_)) taken_.push_back(*chain);
        drawLegend();
        if (hasTriad_ && shown_.gizmo && view_.stereo.kind != vis::StereoKind::SideBySide) drawTriadAt(labels);
        if (view_.showScaleBar && shown_.scaleBar && !info_.timeAxis()) drawBar();
        if (shown_.title) drawTexts();
        drawCentred(equalText(session_, info_));
        if (!status.complete && !context_.headless && !moving) drawProgress(status);
        callouts_.reserve(space, moving, taken_);
        if (view_.showAxes && shown_.axes) drawAxes3d(*list_, space, camera, labels, taken_);
        callouts_.draw(space, *scene_, moving);
        list_->PopClipRect();
    }

    ImVec2 max() const { return picture_.max(); }
    /// The picture that the mouse points into, of the left eye in an anaglyph; null while there is none.
    vis::ViewTarget* picked() const {
        return view_.stereo.kind == vis::StereoKind::SideBySide ? nullptr : cache_.eyes.targets[0].get();
    }
    /// Whether box and cross-hair suit what is shown.
    bool framed() const { return view_.drawingBox || !onlyDrawings(session_); }
    bool showsLegend() const { return view_.showLegend && shown_.legend; }
    /// Whether the animation may change what is shown.
    bool plays() const { return session_.animation.playing && (!view_.time || !session_.animation.tracks.empty()); }

    /// Mouse and keys over the picture; true while something moves.
    bool useHands() {
        chain_.take();
        const SpaceFrame seen = spaceFrame(picture_.min, max(), session_.camera, info_, session_.stretch);
        const bool inCallout =
            callouts_.take(seen, !cache_.hand.dragging() && !cache_.lens.active && !cache_.handles.active);
        mouseArea("picture", picture_.size,
                  ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle |
                      ImGuiButtonFlags_MouseButtonRight);
        cache_.hand.covered = callouts_.held(); // also in the frame in which the menu of one opens
        const bool hovered = ImGui::IsItemHovered() && !cache_.hand.covered;
        const ImVec2 mouse = ImGui::GetIO().MousePos;
        cache_.hand.blocked =
            hasTriad_ && hovered && std::hypot(mouse.x - triadAt_.x, mouse.y - triadAt_.y) < triad_ + em() * 0.5f;
        const SpaceFrame before = spaceFrame(picture_.min, max(), session_.camera, info_, session_.stretch);
        const bool free = hovered && !cache_.hand.dragging() && !cache_.hand.blocked, lenses = view_.showLenses;
        const bool forLens = ImGui::GetIO().KeyAlt; // also where a dot of something else lies over it
        const bool onHandle = lenses && !cache_.lens.active &&
                              editHandles(cache_.handles, session_, info_, before, free && !forLens, view_.showLights);
        const bool onLens = lenses && editLenses(cache_.lens, session_, before, free && cache_.handles.object.empty());
        const bool follows = lenses && followPointer(session_, before, free);
        const bool moving = onHandle || onLens || follows || inCallout ||
                            handleMouse(context_, cache_.hand, picked(), picture_, world_, "menu");
        drawVolumeMenu(context_, "menu", view_, picked(), picture_, world_);
        if (cache_.hand.dragging() || cache_.lens.active || cache_.handles.active) context_.interacting = true;
        return moving;
    }

    /// Draws lines and handles in space, besides the scene.
    void drawObjects(const SpaceFrame& space) {
        if (view_.showCursor && shown_.cursor && framed())
            drawCursor3d(*list_, space, session_.cursor), drawProbes(*list_, space, session_.probes, info_);
        if (!shown_.outlines) return;
        drawSpaceBrushes(*list_, space, session_.selection);
        drawProfileLines(*list_, space, session_);
        drawPlaneInSpace(*list_, space, session_, info_);
        if (!view_.showLenses) return;
        drawLenses(*list_, space, session_, cache_.lens.lens);
        if (!context_.takesInput()) return; // nobody can drag there
        drawLensHandles(*list_, cache_.lens, space, session_);
        drawHandles(*list_, cache_.handles, space, session_, info_, view_.showLights);
    }

    LegendRoom legendRoom() const {
        const std::size_t lines = shown_.title ? upperTexts().left.size() : 1;
        return {picture_.min, max(), em() * (0.5f + kUpperLine * float(std::max<std::size_t>(1, lines)))};
    }

    /// Legends and gizmo go where the box is not, nor the numbers beside it, shown or left out of this picture.
    void placeCorners(const SpaceFrame& space) {
        cache_.legend = {};
        LegendArea legend{max(), max()};
        if (showsLegend()) {
            const std::vector<LegendEntry> entries = sceneLegends(session_, info_, view_.drawingLegend);
            const auto covered = [&](ImVec2 lo, ImVec2 hi) {
                return coveredByBox(space, {lo.x - em(), lo.y - em()}, {hi.x + em(), hi.y + em()});
            };
            const auto numbers = [&](ImVec2 lo, ImVec2 hi) {
                return view_.showAxes ? coveredByAxes(space, session_.camera, lo, hi) : 0;
            };
            cache_.legend = placeLegends(entries, legendRoom(), {covered, numbers}, figureLegends(context_));
            legend = legendArea(entries, legendRoom(), cache_.legend);
        }
        cache_.triad = freeTriadCorner(space, triad_, {legend.min, legend.max});
        triadAt_ = triadMiddle(picture_.min, max(), cache_.triad, triad_);
    }

    void drawLegend() {
        if (!showsLegend()) return;
        const auto entries = withValuesAtCursor(context_, sceneLegends(session_, info_, view_.drawingLegend));
        if (view_.multiple && entries.size() == 1 && drawUprightLegend(entries.front())) return;
        const LegendArea area = drawLegends(*list_, entries, legendRoom(), cache_.legend);
        if (cache_.legend.corner == LegendCorner::BottomRight) legendLeft_ = area.min.x;
        taken_.push_back({area.min, area.max});
    }

    /// A narrow bar at the right edge, beside the object of a small picture; false where it would not do.
    bool drawUprightLegend(const LegendEntry& entry) {
        if (entry.swatch || entry.glyph || entry.opacity || entry.regions || !entry.names.empty()) return false;
        const std::string title = titleWithUnit(entry.title, entry.unit);
        const float width = std::max(ImGui::CalcTextSize(title.c_str()).x, em() * 5), line = ImGui::GetFontSize();
        const float height = std::min(em() * 10, picture_.size.y - em() * 5.5f);
        if (height < line * 3 || width > picture_.size.x / 3) return false;
        const ImVec2 hi{max().x - em() * 0.5f, max().y - em() * 0.5f};
        const ImVec2 lo{hi.x - width - em() * 0.8f, hi.y - height - line - em() * 1.2f};
        list_->AddRectFilled(lo, hi, plotColors().backdrop, em() * 0.25f);
        const float left = lo.x + em() * 0.4f;
        list_->AddText({left, lo.y + em() * 0.3f}, plotColors().text, title.c_str());
        drawLegendColumn(*list_, {left, hi.y - height - em() * 0.4f}, height, entry);
        legendLeft_ = lo.x;
        taken_.push_back({lo, hi});
        return true;
    }

    void drawTriadAt(const AxisLabels& labels) {
        const ImVec2 mouse = ImGui::GetIO().MousePos;
        const auto clicked =
            drawTriad(*list_, triadAt_, triad_, session_.camera, labels, cache_.hand.blocked ? &mouse : nullptr,
                      cache_.hand.blocked && ImGui::IsMouseClicked(ImGuiMouseButton_Left));
        if (clicked) lookAlong(session_.camera, *clicked, world_, picture_.aspect());
        taken_.push_back({{triadAt_.x - triad_, triadAt_.y - triad_}, {triadAt_.x + triad_, triadAt_.y + triad_}});
    }

    void drawBar() {
        const bool beside = hasTriad_ && cache_.triad == TriadCorner::BottomLeft;
        const float left = beside ? triadAt_.x + triad_ + em() : picture_.min.x + em();
        const bool before = hasTriad_ && cache_.triad == TriadCorner::BottomRight;
        const float right = before ? triadAt_.x - triad_ - em() : legendLeft_.value_or(max().x);
        const float most = std::min(em() * 9, right - left - em());
        const ScaleBar bar =
            scaleBar(session_.camera, world_, session_.stretch, info_.lengthUnit, picture_.size.y, most);
        const float width = std::max(bar.pixels, ImGui::CalcTextSize(bar.text.c_str()).x);
        if (bar.pixels >= em() * 2 && left + width < right)
            taken_.push_back(drawScaleBar(*list_, {left, max().y - em() * 0.5f}, bar));
    }

    /// The stretch of the data, that axes are not shown as they lie, what a plane in space and time is, and the time
    /// shown in exported pictures and where it is the view's own: the window has its timeline, but not for such a
    /// plane.
    UpperTexts upperTexts() const {
        std::string stretch = stretchText(session_.stretch, info_.lattice.axes), state;
        if (volume::isStraightened(info_.notes))
            stretch += (stretch.empty() ? "" : ", ") + std::string("oblique axes, shown straight");
        if (info_.plane)
            state = planeText(info_, *info_.plane);
        else if ((!context_.takesInput() || session_.data.timeAxis || view_.time) && info_.times.size() > 1)
            state = stateText(info_, session_.time, session_.data.axis);
        const std::vector<std::string> notes = scene_ ? geometryNotes(*scene_) : std::vector<std::string>();
        return upperTextsOf(state, stretch, notes, chain_.left() - picture_.min.x - em());
    }
    void drawTexts() {
        const UpperTexts texts = upperTexts();
        upperLines_ = texts.left.size();
        const auto write = [&](ImVec2 at, float pivot, ImU32 color, const std::string& text) {
            if (text.empty()) return;
            const ImVec2 size = ImGui::CalcTextSize(text.c_str());
            addTextWithBackdrop(*list_, at, {pivot, 0}, color, text.c_str());
            taken_.push_back({{at.x - pivot * size.x, at.y}, {at.x + (1 - pivot) * size.x, at.y + size.y}});
        };
        const PlotColors colors = plotColors();
        write({chain_.left() - em() * 0.5f, picture_.min.y + em() * 0.4f}, 1, colors.faint, texts.right);
        for (std::size_t i = 0; i < texts.left.size(); ++i)
            write({picture_.min.x + em() * 0.5f, picture_.min.y + em() * (0.4f + kUpperLine * float(i))}, 0,
                  i < texts.faintFrom ? colors.text : colors.faint, texts.left[i]);
    }

    void drawProgress(const vis::FrameStatus& status) {
        std::string text = status.compiling ? "compiling shaders" : "refining";
        if (status.bricksMissing > 0)
            text += ", " + formatCount(status.bricksMissing) + (status.bricksMissing == 1 ? " brick" : " bricks") +
                    " still loading";
        drawUpperLeft(text, plotColors().faint);
    }

    /// In place of a picture that shows nothing.
    void drawCentred(const std::string& text) {
        if (text.empty()) return;
        addFittedWithBackdrop(*list_, {picture_.min.x + picture_.size.x / 2, picture_.min.y + picture_.size.y / 2},
                              {0.5f, 0.5f}, plotColors().text, text, picture_.size.x - em());
    }

    /// Below the other texts there.
    void drawUpperLeft(const std::string& text, ImU32 color) {
        const ImVec2 at{picture_.min.x + em() * 0.5f, picture_.min.y + em() * (0.4f + kUpperLine * float(upperLines_))},
            size = ImGui::CalcTextSize(text.c_str());
        addTextWithBackdrop(*list_, at, {0, 0}, color, text.c_str());
        taken_.push_back({at, {at.x + size.x, at.y + size.y}});
    }

    ViewContext& context_;
    VolumeCache& cache_;
    VolumeView& view_;
    PictureBox picture_;
    Session& session_;
    const Decoration& shown_;
    const volume::DatasetInfo& info_;
    vis::WorldFrame world_;
    float triad_;    ///< radius, pixels
    ImVec2 triadAt_; ///< its middle
    bool hasTriad_;  ///< or would have it: what is left out of a picture keeps its place
    LinkControl chain_;
    const std::string& pane_;
    CalloutsBeside callouts_;
    const vis::Scene* scene_ = nullptr; ///< of this frame
    ImDrawList* list_ = nullptr;
    std::size_t upperLines_ = 0;                   ///< of texts in the upper left corner
    std::optional<float> legendLeft_;              ///< of a legend at the bottom, pixels
    std::vector<std::pair<ImVec2, ImVec2>> taken_; ///< corners of what is drawn already, which labels keep clear of
};

void drawSpace(ViewContext& context, const std::string& pane, VolumeView& view) {
    const ImVec2 room = ImGui::GetContentRegionAvail();
    const PictureBox picture{ImGui::GetCursorScreenPos(), {std::floor(room.x), std::floor(room.y)}};
    if (picture.size.x < 8 || picture.size.y < 8) return;
    SpacePicture(context, cacheOf<VolumeCache>(context, pane), view, picture, pane).draw();
}

/// The data that a plane at all times is cut from, through a renderer of their own.
void drawBeside(ViewContext& context, const std::string& pane, VolumeView& view,
                const std::shared_ptr<const volume::BrickSource>& space) {
    SpaceCache& cache = cacheOf<SpaceCache>(context, pane);
    if (!cache.renderer) cache.renderer = context.renderer.another();
    if (cache.renderer->source() != space.get()) {
        cache.caches.clear();
        cache.renderer->setSource(space);
    }
    const Session before = sessionInSpace(context.session, context.numbers->info(), space->info());
    Session edited = before;
    ViewContext own = innerContext(context, edited, space, *cache.renderer, cache.caches);
    own.renderers = std::max(context.renderers, 2);
    own.runCommand = context.runCommand;
    own.cameraKey = context.cameraKey;
    drawSpace(own, pane, view);
    takeFromSpace(context.session, before, edited, context.numbers->info(), space->info());
    for (std::string& text : cache.renderer->takeMessages()) own.answers.messages.push_back(std::move(text));
    takeAnswers(context, own, "data in space: ");
}

} // namespace

void drawVolumeView(ViewContext& context, const std::string& pane, VolumeView& view) {
    if (!context.source) {
        drawHint("No data", "Open a file, drop one onto the window, or choose example data in the Help menu.");
        return;
    }
    {
        const ShownScene shown(context.session, &view);
        const auto space = view.inSpace ? spaceOfPlane(context) : nullptr;
        space ? drawBeside(context, pane, view, space) : drawSpace(context, pane, view);
    }
    drawLinkMenu(context, view);
}

} // namespace tessera::app
