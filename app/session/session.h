#pragma once

#include "app/session/animation.h"
#include "app/session/callout.h"
#include "app/session/dock_tree.h"
#include "app/session/figure_settings.h"
#include "app/session/views/view_state.h"
#include "codec/pack/pack.h"
#include "codec/remote/remote_options.h"
#include "vis/scene/scene.h"
#include "volume/base/data_units.h"
#include "volume/derived/derived.h"
#include "volume/field/dataset.h"
#include "volume/import/import.h"
#include "volume/sources/time_axis.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

/// The session: everything that decides what is on screen, as one value, and its JSON file (*.tessera.json).
namespace tessera::app {

/// The schema that is written, and the oldest that is read.
inline constexpr int kSessionSchema = 6, kOldestSchema = 2;

/// A data file of a session, identified by path (relative to the session file), size and hash.
struct DataFile {
    std::string path;         ///< relative to the session file where possible, '/' separators
    std::string absolutePath; ///< where it was when saved; tried second
    double bytes = 0;         ///< size when saved, 0 = unknown
    std::string hash;         ///< xxh64 of the first and last MiB, hex, "" = unknown
    bool operator==(const DataFile&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.path, FieldInfo{.key = "path", .doc = "File, relative to the session", .refersTo = "path"});
        visit(self.absolutePath, FieldInfo{"absolutePath", "Absolute path when saved"});
        visit(self.bytes, FieldInfo{.key = "bytes", .doc = "Size when saved", .unit = "byte"});
        visit(self.hash, FieldInfo{"hash", "xxh64 of the first and last MiB when saved"});
    }
};

/// Lattice of pictures of regular grids, of files and archives. Numbers always come from the samples of the grid.
/// Of a grid with uneven axes, `Grid` draws each cell as thick as any other, `Even` to scale.
enum class PictureLattice { Grid, BodyCentred, Even };
inline constexpr std::string_view kPictureLatticeNames[] = {"grid", "bodyCentred", "even"};

/// What is shown of an archive on D4* or BCC: both of its grids (of D4* at every time), or one grid as it is stored.
enum class ShownGrids { Both, First, Second };
inline constexpr std::string_view kShownGridsNames[] = {"both", "first", "second"};

/// A second data set, whose parameters are added to those of the first.
struct OtherData {
    std::vector<DataFile> files;
    std::string model;
    std::map<std::string, double> settings;
    volume::ImportOptions import;
    std::optional<DataFile> table = {}; ///< import.overTime when saved
    bool operator==(const OtherData&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.files, FieldInfo{"files", "Files of the other data set"});
        visit(self.model, FieldInfo{"model", "Built-in model, if there is no file"});
        visit(self.settings, FieldInfo{"settings", "Settings of the model"});
        visit(self.import, FieldInfo{"import", "What the user stated about the files"});
        visit(self.table, FieldInfo{"table", "File of quantities over time, as it was when saved"});
    }
};

/// What is shown: files, or a model computed by the program.
struct DataRef {
    std::vector<DataFile> files;            ///< an archive, or data files opened together
    std::string model;                      ///< "fuel-cell", "marschner-lobb", ...: used when there are no files
    std::map<std::string, double> settings; ///< of the model: e.g. nx, ny, nz, times
    PictureLattice lattice = PictureLattice::BodyCentred;
    ShownGrids grids = ShownGrids::Both;
    std::vector<volume::DerivedParameter> derived; ///< computed from the others
    volume::ImportOptions import;                  ///< options for what the files do not state themselves
    std::optional<codec::PackOptions> packed;      ///< unpacked data are shown as an archive packed so holds them
    bool originals = false;                        ///< packed data are shown beside those as computed
    std::string axis;                              ///< quantity that replaces the times, "" = none
    std::optional<volume::TimeAxis> timeAxis;      ///< shows a plane in space and time instead of the data
    std::optional<OtherData> other = {};           ///< its parameters are added as "T (other)"
    codec::RemoteOptions remote = {};              ///< how archives on other machines are read
    std::optional<DataFile> table = {};            ///< import.overTime when saved: found again as the files are
    bool operator==(const DataRef&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.files, FieldInfo{"files", "Data files, shown together"});
        visit(self.model, FieldInfo{"model", "Built-in model, if there is no file"});
        visit(self.settings, FieldInfo{"settings", "Settings of the model"});
        visit(self.lattice,
              FieldInfo{.key = "lattice",
                        .doc = "Lattice that pictures are drawn from: the grid of the data as it is, or body-centred "
                               "with 70.7 % of the samples, corrected by what they leave of those of the grid; where "
                               "spacing is uneven, the first two draw all cells equally thick, and even draws them to "
                               "scale; numbers always come from the grid",
                        .names = kPictureLatticeNames});
        visit(self.grids,
              FieldInfo{.key = "grids",
                        .doc =
                            "Of an archive on D4*, the lattice in space and time: both of its grids at every time, of "
                            "which one is computed from the times before and after, or one grid alone at its own "
                            "times, with the samples as stored; of one on BCC: both grids, or one alone",
                        .names = kShownGridsNames});
        visit(self.derived, FieldInfo{.key = "derived", .doc = "Parameters computed from the others", .hidden = true});
        visit(self.import, FieldInfo{"import", "What the user stated about the files"});
        visit(self.packed,
              FieldInfo{
                  "packed",
                  "Show data files as an archive packed with these options, or with this preset, would store them"});
        visit(self.originals, FieldInfo{"originals", "With `packed`: also show the parameters as computed"});
        visit(self.axis, FieldInfo{"axis", "Quantity over time to use as the time axis, if it rises or falls "
                                           "throughout; otherwise it is listed first"});
        visit(self.timeAxis,
              FieldInfo{"timeAxis", "Show a plane in space and time in place of the data: time along an axis of "
                                    "space, or any"});
        visit(self.other,
              FieldInfo{"other",
                        "Another data set; its parameters are added as \"T (other)\", interpolated onto this grid"});
        visit(self.remote, FieldInfo{"remote", "How archives on other machines are read"});
        visit(self.table, FieldInfo{"table", "File of quantities over time, as it was when saved"});
    }
};

/// What the user allowed files to name (ImportOptions::allowOutside), which no JSON says: taken over where a session is
/// made of the JSON of one that is open.
inline void takeAllowed(DataRef& to, const DataRef& from) {
    to.import.allowOutside = from.import.allowOutside;
    if (to.other && from.other) to.other->import.allowOutside = from.other->import.allowOutside;
}

/// A place and time whose values are kept in a list.
struct Probe {
    std::string name;
    glm::dvec3 position{0}; ///< physical
    double time = 0;        ///< in the unit of the data's times
    bool operator==(const Probe&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.name, FieldInfo{"name", "Name of the probe"});
        visit(self.position, FieldInfo{.key = "position", .doc = "Where it is", .unit = kUnitOfLengths});
        visit(self.time, FieldInfo{.key = "time", .doc = "Its time", .unit = kUnitOfTimes});
    }
};

enum class Theme { Dark, Light };
inline constexpr std::string_view kThemeNames[] = {"dark", "light"};

/// In what form colour legends stand in a corner of a figure.
enum class FigureLegends { Automatic, Whole, Lines };
inline constexpr std::string_view kFigureLegendsNames[] = {"automatic", "whole", "lines"};

struct Appearance {
    Theme theme = Theme::Dark;
    float scale = 1; ///< user factor on top of the display's
    FigureLegends legends = FigureLegends::Automatic;
    bool operator==(const Appearance&) const = default;
    static void describe(auto& self, auto&& visit) {
        visit(self.theme, FieldInfo{.key = "theme", .doc = "Colours of the window", .names = kThemeNames});
        visit(self.scale, FieldInfo{.key = "scale", .doc = "Size of text and controls", .range = Range{0.5, 3}});
        visit(self.legends,
              FieldInfo{.key = "legends",
                        .doc = "Colour legends in a corner of a figure: whole, with ticks; one line each, which covers "
                               "less; or automatic: whole unless they would cover the object in a small figure. Those "
                               "that do not all fit whole are lines",
                        .names = kFigureLegendsNames});
    }
};

struct Session {
    int schema = kSessionSchema;
    std::string title;
    DataRef data;
    // What all views share.
    double time = 0;
    glm::dvec3 cursor{0}; ///< physical; the linked cross-hair
    std::vector<Probe> probes;
    glm::dvec3 stretch{1};
    vis::Camera camera;
    vis::Selection selection;
    std::vector<vis::Brush> layoutBrushes; ///< those of `selection` that the layout brought, as it brought them
    std::map<std::string, vis::TransferFunction> transfer; ///< by channel name
    std::vector<vis::Layer> layers;
    vis::RenderParams render;
    vis::Lighting lighting;
    std::vector<vis::Clip> clips;
    std::vector<vis::Lens> lenses; ///< a later one lies over those before it
    std::vector<Callout> callouts;
    vis::Tone tone;
    vis::DepthMask depthMask;
    std::optional<vis::Paper> paper; ///< in place of the theme's background
    Animation animation;
    Appearance appearance;
    FigureSettings figure;
    // What is open, and where.
    std::map<std::string, ViewState> views; ///< by pane key, e.g. "volume", "slices", "volume-2"
    DockTree dock;

    // Defined in session.cpp: to copy, compare and destroy so much is too long to stand in every file that does.
    Session();
    Session(const Session&);
    Session(Session&&) noexcept;
    Session& operator=(const Session&);
    Session& operator=(Session&&) noexcept;
    ~Session();
    bool operator==(const Session&) const;
    static void describe(auto& self, auto&& visit) {
        visit(self.schema, FieldInfo{.key = "schema", .doc = "Version of this format", .hidden = true});
        visit(self.title, FieldInfo{"title", "What this session shows"});
        visit(self.data, FieldInfo{"data", "The data set"});
        visit(self.time, FieldInfo{.key = "time", .doc = "Time shown in every view", .unit = kUnitOfTimes});
        visit(self.cursor,
              FieldInfo{.key = "cursor", .doc = "Position of the linked cross-hair", .unit = kUnitOfLengths});
        visit(self.probes, FieldInfo{"probes", "Places and times whose values are kept in a list"});
        visit(self.stretch, FieldInfo{.key = "stretch",
                                      .doc = "Factor by which each axis is stretched; 1 = true proportions",
                                      .range = Range{0.01, 1e6},
                                      .logScale = true});
        visit(self.camera, FieldInfo{"camera", "Camera of the 3D views"});
        visit(self.selection, FieldInfo{"selection", "Brushes shared by all views"});
        visit(self.layoutBrushes, FieldInfo{.key = "layoutBrushes",
                                            .doc = "Brushes as the layout brought them: another layout takes them away",
                                            .hidden = true});
        visit(self.transfer, FieldInfo{"transfer", "Transfer functions by parameter"});
        visit(self.layers, FieldInfo{"layers", "Layers drawn in the 3D views"});
        visit(self.render, FieldInfo{"render", "Settings of the ray caster"});
        visit(self.lighting, FieldInfo{"lighting", "Lights and surfaces"});
        visit(self.clips, FieldInfo{"clips", "Planes and bodies that cut the data open"});
        visit(self.lenses, FieldInfo{"lenses", "Lenses; a later one lies over an earlier one"});
        visit(self.callouts,
              FieldInfo{"callouts", "Details beside the volume, joined to a lens, brush or plane in it"});
        visit(self.tone, FieldInfo{"tone", "Mapping of bright light to the range of the screen"});
        visit(self.depthMask, FieldInfo{"depthMask", "Shadows of depth around what stands before something else"});
        visit(self.paper, FieldInfo{"paper", "Paper behind the picture; none: the background of the theme"});
        visit(self.animation, FieldInfo{"animation", "Playing through time or keyframes"});
        visit(self.appearance, FieldInfo{"appearance", "Appearance of the window"});
        visit(self.figure, FieldInfo{"figure", "Texts and axes of figures"});
        visit(self.views, FieldInfo{"views", "Views by the name of their pane"});
        visit(self.dock, FieldInfo{.key = "dock", .doc = "Arrangement of the panes", .hidden = true});
    }
};

/// The scene the session's 3D views show (a volume view's own settings are applied on top by the view).
vis::Scene sceneOf(const Session& session);

/// The name of the first parameter with three components, "" if there is none.
std::string firstVector(const volume::DatasetInfo& info);

/// Channels of scalars that are no labels and have a range, in order: indices into channels().
std::vector<int> scalarChannels(const volume::DatasetInfo& info);

/// The channel to look at first: a scalar with a range, the magnitude of a vector, else anything that is not a label;
/// "" if there is none.
std::string firstChannel(const volume::DatasetInfo& info);

/// The name of a layer: the user's, else what it shows, "T surface", "T volume", "T slice z", "U flow".
std::string layerName(const vis::Layer& layer);

/// Samples that data with uneven axes may have so that pictures of them are to scale.
inline constexpr double kMostToScale = 16e6;
/// Whether pictures of data with uneven axes are to scale: resampled to an even grid, which BCC data, those on another
/// machine and those of more than kMostToScale samples are not. `info`: of the numbers.
bool drawsToScale(PictureLattice lattice, const volume::DatasetInfo& info);
/// What a choice means for data that have these numbers: `Even` is for uneven axes alone, others are drawn as usual;
/// those that cannot be drawn to scale are drawn by cells.
PictureLattice latticeFor(PictureLattice chosen, const volume::DatasetInfo& info);

/// The session's lenses in the space of its data.
vis::LensSpace lensSpace(const Session& session, const volume::DatasetInfo& info);
/// What brushes need to select by positions: lenses only where brushes are lenses, so that answers to questions about
/// others hold while the camera moves; the axes where they are uneven.
vis::LensSpace brushSpace(const Session& session, const volume::DatasetInfo& info);

/// The pane keys of a session, and the name a reader sees for one: "Volume", "Volume 2", ...
std::vector<std::string> paneKeys(const Session& session);
std::string paneTitle(const Session& session, const std::string& pane);

/// A view of a kind ("volume", "slices", ...) as it is at first; nothing for a kind that there is not.
std::optional<ViewState> viewOfKind(std::string_view kind);

/// Adds a view of a kind ("volume", "slices", ...) as a tab beside the first pane; returns its key.
std::string addView(Session& session, const ViewState& view);

/// Gives derived differences that have no transfer function yet diverging colours with 0 in the middle.
void colorDifferences(Session& session);

/// Makes a session fit a data set: the dock tree holds exactly the open views, parameters that do not exist are
/// replaced by ones that do (one message each), brushes on absent parameters are dropped, cursor and time lie inside.
void fitSession(Session& session, const volume::DatasetInfo& info, std::vector<std::string>& messages);

/// The default session for a data set: layers, transfer functions, stretch of thin domains, cross-hair in the middle,
/// the overview arrangement of panes.
Session defaultSession(const volume::DatasetInfo& info, const DataRef& data);

} // namespace tessera::app
