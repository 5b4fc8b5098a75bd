#pragma once

#include "app/data/growth_watch.h"
#include "app/data/open.h"
#include "app/pane/view_context.h"
#include "app/ui/commands.h"
#include "app/ui/dock.h"
#include "app/ui/file_dialog.h"
#include "app/ui/jobs.h"
#include "app/ui/messages.h"
#include "app/ui/theme.h"
#include "app/user_files/state_dir.h"
#include "app/views/timeline/playback.h"
#include "vis/image/image_io.h"

#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <set>

/// The workbench: one session, its data, and what surrounds the views. Knows nothing of windows: the platform makes an
/// ImGui context and a GL context current, calls prepare(), starts ImGui's frame, calls frame(), and draws.
namespace tessera::app {

/// A picture of the window, or of one pane, at any size.
struct PictureRequest {
    std::string pane;            ///< "" = the whole window
    glm::ivec2 size{1920, 1080}; ///< pixels
    float scale = 1;             ///< pixels per design pixel
    bool controls = false;       ///< one pane with its rows of tools
};

struct WorkbenchOptions {
    std::shared_ptr<vis::Renderer> renderer = {}; ///< null: one of its own
    vis::RendererOptions render = {};             ///< for one of its own
    bool headless = false;        ///< pictures: no messages, dialogs or remembered files; every frame is finished
    std::string onlyPane = {};    ///< shows this pane alone, without its strip
    bool controls = false;        ///< with its rows of tools, headless too
    std::string stateFolder = {}; ///< recent files and autosave; "" remembers nothing
    std::string program = "/proc/self/exe"; ///< is run as a child to pack
    /// How often an archive that is shown is looked at for new times.
    std::chrono::milliseconds growthInterval = std::chrono::seconds(1);
    /// How often what has been edited is kept for the case that the program ends by itself.
    std::chrono::milliseconds autosaveInterval = std::chrono::seconds(10);
    /// Called after each pane is drawn, for measurements: `behind` while it still shows an older state of the session.
    std::function<void(const std::string& pane, bool behind)> paneDrawn = {};
};

class Workbench {
public:
    explicit Workbench(WorkbenchOptions options);
    ~Workbench();
    Workbench(const Workbench&) = delete;
    Workbench& operator=(const Workbench&) = delete;

    /// Opens in the background, after asking whether to save what has changed; what is shown stays until the new data
    /// are ready.
    void open(OpenRequest request);
    /// Takes over what open() returned, at once.
    void install(Opened opened);
    /// Shows another data set beside the one shown and how the parameter shown first differs, in the background; with
    /// no paths takes it away.
    void compareWith(const std::vector<std::string>& paths);

    /// Fonts and style for a display; call before ImGui::NewFrame. True when the font atlas changed and must be
    /// uploaded.
    bool prepare(float contentScale);
    /// Draws one frame, between ImGui::NewFrame and ImGui::Render.
    void frame();
    /// After the frame is on screen: work that needs the GL context to itself (pictures).
    void afterFrame();

    /// Seconds the platform may sleep before the next frame: 0 = draw at once, infinity = wait for input.
    double idleSeconds() const;
    /// True while a view refines or data are being read: a picture taken now would not be final.
    bool busy() const { return busy_ || jobs_.list().size() > 0; }
    bool finished() const { return quit_; }
    /// Asks to end, and to save first if there is something to save.
    void requestQuit();

    Jobs& jobs() { return jobs_; }
    const Session& session() const { return session_; }
    Session& session() { return session_; }
    const History& history() const { return history_; }
    std::shared_ptr<const volume::BrickSource> source() const { return source_; }
    /// What numbers are read from.
    std::shared_ptr<const volume::BrickSource> numbers() const { return numbers_; }
    const NumberOrigin& origin() const { return origin_; }
    std::shared_ptr<vis::Renderer> renderer() const { return renderer_; }
    SessionDocument document() const;
    std::string windowTitle() const;
    void message(const std::string& text, bool failure = false);
    const std::vector<Command>& commands() const { return commands_; }
    /// What the view of a pane keeps between frames; null before it was drawn.
    const ViewCache* cache(const std::string& pane) const {
        const auto found = caches_.find(pane);
        return found == caches_.end() ? nullptr : found->second.get();
    }

    /// What the view of a pane can be exported as, headless; null where it offers nothing.
    const ViewExport* exported(const std::string& pane) const {
        const auto found = exports_.find(pane);
        return found == exports_.end() ? nullptr : &found->second;
    }

    /// Makes a picture of a session; given by the platform.
    std::function<vis::Image(const SessionDocument&, const Sources&, std::shared_ptr<vis::Renderer>,
                             const PictureRequest&)>
        takePicture;

private:
    static constexpr const char* kLatticeChoice = "lattice"; ///< by this name it is remembered
    struct Export {
        PictureRequest request;
        std::string path;
    };

    void makeCommands();                                     // workbench_commands.cpp
    void addFileCommands();                                  // workbench_commands.cpp
    void addEditCommands();                                  // workbench_commands.cpp
    void addDifferenceCommands();                            // workbench_commands.cpp
    void addHelpCommands();                                  // workbench_commands.cpp
    void showSpaceBeside(bool wanted);                       // workbench_view_commands.cpp
    void addViewCommands();                                  // workbench_view_commands.cpp
    void openView(const ViewState& view);                    // workbench_view_commands.cpp
    void addLayoutCommands();                                // workbench_view_commands.cpp
    void drawMenus();                                        // workbench_commands.cpp
    void drawDialogs();                                      // workbench_dialogs.cpp
    void drawMissing();                                      // workbench_dialogs.cpp
    void drawRecovery();                                     // workbench_dialogs.cpp
    void drawExport();                                       // workbench_dialogs.cpp
    void drawLeaving();                                      // workbench_dialogs.cpp
    void drawHelp();                                         // workbench_dialogs.cpp
    void drawImportOptions();                                // workbench_import.cpp
    FilePreview previewOf(const std::string& path);          // workbench_import.cpp
    void filesChosen(const std::vector<std::string>& paths); // workbench_import.cpp
    void drawStatusBar(float height);                        // workbench_panes.cpp
    void drawPane(const std::string& pane);                  // workbench_panes.cpp

    /// Does what gives the session up: at once, or after asking whether to save what has changed.
    void leave(std::function<void()> go);
    void start(const OpenRequest& request);
    OpenRequest withChoices(OpenRequest request) const;
    void answerFile(const FileDialog::Answer& answer);
    void save(const std::string& path);
    int chosenSurface() const;            // workbench_surface.cpp
    void exportSurface(std::string path); // workbench_surface.cpp

    /// What a job made to be shown in place of `from`: the same data otherwise.
    struct Remade {
        std::shared_ptr<const volume::BrickSource> from;
        Sources sources;
        DataRef data;
        std::vector<std::string> messages;
    };
    bool showsDataFiles() const;                                // workbench_data.cpp
    void pack(const std::string& path);                         // workbench_data.cpp
    void showAs(const DataRef& data, const std::string& title); // workbench_data.cpp
    bool show(Remade remade);                                   // workbench_data.cpp
    void replace(Session session);
    void watchEdits();
    void autosave();
    double nextAutosave() const; ///< s, as now()
    Sources sources() const { return {source_, numbers_, origin_}; }
    void take(Sources sources, std::optional<vis::SameSamples> grown = {}); // workbench_data.cpp
    void followLattice();                                                   // workbench_data.cpp
    void followLabels();                                                    // workbench_data.cpp
    void followDerived();                                                   // workbench_data.cpp
    void followAxis();                                                      // workbench_data.cpp
    void addTable(const std::string& path);                                 // workbench_data.cpp
    void followGrowth();                                                    // workbench_growth.cpp
    void play();
    void step(int count);
    void closePane(const std::string& pane);
    std::string currentPane() const;
    std::string spacePane() const; // workbench_panes.cpp
    double now() const;
    bool dirty() const;

    WorkbenchOptions options_;
    std::shared_ptr<vis::Renderer> renderer_;
    std::shared_ptr<const volume::BrickSource> source_, numbers_; ///< of pictures, and of numbers
    NumberOrigin origin_;                                         ///< of the numbers
    Session session_;
    History history_;
    std::vector<JsonIssue> unknown_;
    Session saved_;                                                      ///< as last saved or opened
    std::vector<volume::DerivedParameter> derivedShown_, derivedWanted_; ///< of the source, and of one being made
    PictureLattice latticeShown_ = {}, latticeWanted_ = {};              ///< likewise
    /// What the times of the data depend on.
    struct CountedBy {
        std::string axis;
        std::optional<volume::TimeAxis> along;
        std::string overTime;
        bool operator==(const CountedBy&) const = default;
    };
    static CountedBy countedBy(const DataRef& data);
    CountedBy countedShown_, countedWanted_;              ///< likewise
    std::vector<std::string> labelsShown_, labelsWanted_; ///< names of labels, likewise
    std::string sessionPath_;
    std::map<std::string, std::unique_ptr<ViewCache>> caches_;
    std::map<std::string, ViewExport> exports_; ///< by pane, headless
    int renderers_ = 1;                         ///< the window's and those of views, which share the limits of memory
    Fonts fonts_;
    float scale_ = 0, contentScale_ = 1;
    Theme theme_ = Theme::Dark;
    bool styled_ = false;

    std::vector<Command> commands_;
    std::function<void()> chosen_; ///< a command picked this frame, run before the next one
    CommandPalette palette_;
    DockHand hand_;
    FileDialog files_;
    volume::ImportOptions import_;
    std::string importAbsent_, importUnits_, importNames_;
    bool formStated_ = false; ///< by a sidecar of the files chosen: it wins over a layout typed before
    std::map<std::string, FilePreview> previews_;
    std::optional<Opened> missing_;
    std::size_t locating_ = 0;
    std::unique_ptr<Autosave> autosave_;
    std::vector<Recovery> recoveries_;
    Messages messages_;
    std::string focusedPane_, hoveredPane_;
    std::set<std::string> drawn_, drawnBefore_; ///< panes of this frame and of the last
    std::string lastSpacePane_;                 ///< the view of the scene that the hand was on last
    std::string cameraPane_;                    ///< the one that cameraKey_ is for
    int cameraKey_ = 0;                         ///< of a camera command picked in a menu, 0 = none
    Playback playback_;
    std::optional<Export> export_;
    std::function<std::string(const Progress&)> exportText_;     ///< what the next answer of "export" writes
    std::function<void(Session&, const std::string&)> takeFile_; ///< what the next answer of "take" does
    PictureRequest picture_;
    bool askPicture_ = false, askHelp_ = false, askAbout_ = false;
    bool quit_ = false, busy_ = true, compiling_ = false, interacting_ = false;
    std::function<void()> leaving_;   ///< waits for the answer whether to save
    std::function<void()> afterSave_; ///< waits for the session to be saved
    bool popupShown_ = false;         ///< at the start of the last frame
    double lastAutosave_ = 0, lastFrame_ = 0;
    bool unsavedEdits_ = false;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::array<std::unique_ptr<GrowthWatch>, 2> growth_; ///< of the archives that are shown, the first and the other
    Jobs jobs_;                                          ///< last: its threads end before what they refer to
};

} // namespace tessera::app
