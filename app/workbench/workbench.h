#pragma once

#include "app/dialogs/dialogs.h"
#include "app/dialogs/file_questions.h"
#include "app/dialogs/machine_dialog.h"
#include "app/dialogs/picture_request.h"
#include "app/document/autosaver.h"
#include "app/document/data_follower.h"
#include "app/document/document.h"
#include "app/workbench/cancelled_drag.h"
#include "app/workbench/idle_moment.h"
#include "app/workbench/keyboard_focus.h"
#include "app/workbench/pane_host.h"
#include "app/workbench/window_look.h"
#include "vis/image/image_io.h"

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// The workbench: one document with its views, menus, messages and dialogs. Independent of windows: the platform makes
/// an ImGui context and a GL context current, calls prepare(), starts ImGui's frame, calls frame(), and draws.
namespace tessera::app {

struct WorkbenchOptions {
    std::shared_ptr<vis::Renderer> renderer = {}; ///< null: one of its own
    vis::RendererOptions render = {};             ///< for one of its own
    bool headless = false; ///< for pictures: no messages, dialogs or remembered files; every frame is drawn to the end
    std::string onlyPane = {};              ///< shows this pane alone, without its strip
    bool controls = false;                  ///< with its rows of tools, headless too
    Decoration decoration = {};             ///< what may be drawn over the data
    bool whiteGround = false;               ///< in place of the theme's
    std::string stateFolder = {};           ///< recent files and autosave; "" remembers nothing
    std::string program = "/proc/self/exe"; ///< is run as a child to pack
    /// Interval of checks for new times in the archives shown.
    std::chrono::milliseconds growthInterval = std::chrono::seconds(1);
    /// Interval of autosaves.
    std::chrono::milliseconds autosaveInterval = std::chrono::seconds(10);
    /// Called from any thread when there is something new for another frame: wakes the event loop.
    std::function<void()> wake = {};
    /// Called after each pane is drawn, for measurements: `behind` while it still shows an older state of the session.
    std::function<void(const std::string& pane, bool behind)> paneDrawn = {};
};

/// Writes a picture of a session to a path, whose suffix says the form; implemented by the platform. Throws Error.
using WritePicture = std::function<void(const SessionDocument&, const Sources&, std::shared_ptr<vis::Renderer>,
                                        const PictureRequest&, const std::string& path)>;

class Workbench {
public:
    explicit Workbench(WorkbenchOptions options);
    ~Workbench();
    Workbench(const Workbench&) = delete;
    Workbench& operator=(const Workbench&) = delete;

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

    /// Opens in the background, after asking whether to save what has changed; what is shown stays until the new data
    /// are ready.
    void open(OpenRequest request);
    /// Opens a session from its text, as open() does. Throws Error if it is not one.
    void openText(const std::string& text);
    /// Takes over what open() of app/data returned, at once.
    void install(Opened opened);
    /// Saves where the session was saved before, else asks where.
    void save() { saveThen({}); }
    void saveAs();
    /// Quits, after asking whether to save changes.
    void requestQuit();
    void message(const std::string& text, bool failure = false) { messages_.add(text, failure); }
    /// Does something after asking, at once in pictures. `yes`: the word on the button that does it.
    void ask(const std::string& text, const std::string& yes, std::function<void()> go);

    Jobs& jobs() { return jobs_; }
    Messages& messages() { return messages_; }
    Document& document() { return document_; }
    DataFollower& data() { return data_; }
    PaneHost& panes() { return panes_; }
    FileQuestions& files() { return files_; }
    MissingFilesDialog& missingFiles() { return missing_; }
    PictureDialog& pictureDialog() { return pictures_; }
    HelpDialogs& help() { return help_; }
    CommandPalette& palette() { return palette_; }
    KeyboardFocus& keyboard() { return keyboard_; }
    const WindowLook& look() const { return look_; }
    const std::vector<Command>& commands() const { return commands_; }

    const Session& session() const { return document_.session(); }
    Session& session() { return document_.session(); }
    const History& history() const { return document_.history(); }
    std::shared_ptr<const volume::BrickSource> source() const { return document_.sources().pictures; }
    /// The source of numbers.
    std::shared_ptr<const volume::BrickSource> numbers() const { return document_.sources().numbers; }
    const NumberOrigin& origin() const { return document_.sources().origin; }
    std::shared_ptr<vis::Renderer> renderer() const { return renderer_; }
    const ViewCache* cache(const std::string& pane) const { return panes_.cache(pane); }
    const ViewExport* exported(const std::string& pane) const { return panes_.exported(pane); }

    WritePicture writePicture; ///< given by the platform

private:
    /// A picture that is taken after the frame.
    struct PictureJob {
        PictureRequest request;
        std::string path;
    };

    /// Runs an action that discards the session: at once, or after asking whether to save changes.
    void leave(std::function<void()> go);
    void start(const OpenRequest& request);
    /// Opens a session with the data it names, or asks for those that are missing.
    void openWhole(const std::shared_ptr<Opened>& opened, const std::string& title);
    void recover(const Recovery& recovery);
    /// Starts the jobs that wait for a machine again, or says that it is not asked.
    void decide(MachineDialog::Decision decision);
    /// `then` is called when the session is saved.
    void saveThen(std::function<void()> then);
    bool saveTo(const std::string& path);
    void exportText(const std::string& path, std::function<std::string(const Progress&)> make);
    void exportFigure(const std::string& path, std::function<VectorPage(const Progress&)> make);

    double now() const; ///< s
    /// An item is held; a field of text only while keys are pressed in it, so that pictures are refined once these
    /// rest.
    bool interacting();
    ViewContext viewContext();
    void pressKeys();
    void drawPaletteOfAll();
    void drawWindow();
    std::string whyEmpty() const; ///< what went wrong last, where nothing is open
    void drawMenus();
    void drawRecentFiles();
    void drawDialogs();
    void play();

    WorkbenchOptions options_;
    std::shared_ptr<vis::Renderer> renderer_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    Messages messages_;
    Document document_;
    WindowLook look_;
    PaneHost panes_;
    DataFollower data_;
    std::unique_ptr<Autosaver> autosaver_; ///< null headless

    FileQuestions files_;
    MissingFilesDialog missing_;
    RecoveryDialog recovery_;
    PictureDialog pictures_;
    LeaveDialog leave_;
    QuestionDialog question_;
    MachineDialog machines_;
    HelpDialogs help_;
    std::vector<Command> commands_;
    CommandPalette palette_;
    KeyboardFocus keyboard_;
    CancelledDrag cancelledDrag_;
    IdleMoment memory_;            ///< when free memory is given back
    std::function<void()> chosen_; ///< command chosen in this frame, run before the next one

    std::optional<PictureJob> picture_;
    bool quit_ = false, busy_ = true, hurries_ = true;
    double frameBegan_ = 0;   ///< the last one
    double typed_ = -1e9;     ///< when a key was last pressed in a field of text
    bool popupShown_ = false; ///< at the start of the last frame
    Jobs jobs_;               ///< last: its threads end before what they refer to
};

} // namespace tessera::app
