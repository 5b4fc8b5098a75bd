#include "app/data/apply_layout.h"
#include "app/history/session_file.h"
#include "app/platform/headless.h"
#include "tests/app/workbench_fixture.h"
#include "tests/resident_memory.h"
#include "volume/system/confine.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <epoxy/gl.h>
#include <filesystem>
#include <fstream>
#include <functional>
#include <gmock/gmock.h>
#include <random>
#include <thread>

/// Random input to the whole window: mouse, keys, text, commands of the menus. Nothing may crash, no call of GL may
/// fail, and whatever state results is the same once saved and opened again.
///
/// TESSERA_MONKEY_MINUTES: how long (default: some hundred inputs); TESSERA_MONKEY_SEED. Every input is written to
/// monkey.log in the temporary folder of the test before it happens.
namespace tessera::app {
namespace {

namespace fs = std::filesystem;

double numberFrom(const char* name, double otherwise) {
    const char* const text = std::getenv(name);
    return text ? std::atof(text) : otherwise;
}

/// Random names in dialogs must not harm files of the user: only a folder of the test can be written.
class Cage {
public:
    Cage() : folder_(fs::path(testing::TempDir()) / ("monkey_" + std::to_string(::getpid()))) {
        fs::create_directories(folder_ / "state");
        fs::current_path(folder_);
        confined_ = volume::confine({.writable = {testing::TempDir(), "/dev"}});
    }

protected:
    fs::path folder_;
    bool confined_;
};

class Monkey : private Cage, public DrawnWorkbench {
protected:
    Monkey()
        : DrawnWorkbench({.stateFolder = (fs::current_path() / "state").string(),
                          .program = "/bin/false",
                          .autosaveInterval = std::chrono::seconds(2)}) {}

    void SetUp() override {
        if (!confined_) GTEST_SKIP() << "this kernel cannot confine the test to its folder";
        log_.open(folder_ / "monkey.log");
        workbench.writePicture = [](const auto&... what) { app::writePicture(what...); };
        ImGui::GetIO().SetClipboardTextFn = [](void*, const char*) {};
        ImGui::GetIO().GetClipboardTextFn = [](void*) { return "0.5"; };
    }

    void note(const std::string& what) { log_ << step_ << ' ' << what << std::endl; }
    int below(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }
    bool chance(double of) { return std::uniform_real_distribution<double>(0, 1)(random_) < of; }

    void startAnywhere() {
        const std::vector<std::string> layouts = layoutNames();
        start(layouts[std::size_t(below(int(layouts.size())))], {1000, 700});
    }

    void start(const std::string& layout, glm::ivec2 size) {
        OpenRequest request;
        request.layout = layout;
        request.data.emplace();
        request.data->model = "fuel-cell";
        request.data->settings = {{"nx", 9}, {"ny", 9}, {"nz", 21}, {"times", 3}};
        note("layout " + request.layout);
        Opened opened = open(request);
        opened.document.session.render.samples = 1;
        opened.document.history.reset(opened.document.session);
        letGo();
        workbench.install(std::move(opened));
        window_.emplace(size);
        size_ = size;
    }

    void letGo() {
        std::fill(std::begin(down_), std::end(down_), false);
        ctrl_ = shift_ = alt_ = false;
    }

    void show() {
        window_->draw(workbench, 1, [this](ImGuiIO& io) {
            io.MousePos = mouse_;
            for (int i = 0; i < 3; ++i) io.MouseDown[i] = down_[i];
            io.MouseWheel = wheel_;
            feedModifiers(io, ctrl_, shift_, alt_);
            if (key_ != 0) feedKey(io, key_, keyDown_);
            for (const char c : text_) io.AddInputCharacter(static_cast<unsigned char>(c));
        });
        workbench.afterFrame();
        wheel_ = 0;
        key_ = 0;
        text_.clear();
        const GLenum error = glGetError();
        ASSERT_EQ(error, GLenum(GL_NO_ERROR)) << "after input " << step_;
    }

    void tap(int key) {
        key_ = key;
        keyDown_ = true;
        show();
        key_ = key;
        keyDown_ = false;
        show();
    }

    void moveMouse() {
        const bool near = chance(0.6);
        const auto axis = [&](float at, int size) {
            return near ? std::clamp(at + float(below(81) - 40), 0.0f, float(size - 1)) : float(below(size));
        };
        mouse_ = {axis(mouse_.x, size_.x), axis(mouse_.y, size_.y)};
        note("mouse " + std::to_string(int(mouse_.x)) + " " + std::to_string(int(mouse_.y)));
        show();
    }

    void press() {
        const int which = chance(0.75) ? 0 : chance(0.8) ? 1 : 2;
        note("button " + std::to_string(which));
        down_[which] = !down_[which];
        show();
    }

    void type() {
        static constexpr int kKeys[] = {key::kSpace,  key::kEscape,   key::kEnter, key::kTab,  key::kBackspace,
                                        key::kDelete, key::kRight,    key::kLeft,  key::kDown, key::kUp,
                                        key::kPageUp, key::kPageDown, key::kHome,  key::kEnd,  key::kF1,
                                        key::kF5,     key::kF6,       key::kF10,   key::kF11,  key::kF12};
        const int code = chance(0.5)   ? kKeys[below(int(std::size(kKeys)))]
                         : chance(0.8) ? 'A' + below(26)
                                       : '0' + below(10);
        ctrl_ = chance(0.2);
        shift_ = chance(0.2);
        alt_ = chance(0.05);
        note("key " + std::to_string(code) + (ctrl_ ? " ctrl" : "") + (shift_ ? " shift" : "") + (alt_ ? " alt" : ""));
        tap(code);
        ctrl_ = shift_ = alt_ = false;
    }

    void write() {
        static constexpr const char* kTexts[] = {"0", "1",   "-1",  "3.5", "1e9", "-1e-30", "nan", "p",     "T > 340",
                                                 "(", "H2O", "x*y", "/",   "..",  "name",   "a b", "100000"};
        text_ = kTexts[below(int(std::size(kTexts)))];
        note("text " + text_);
        show();
        if (chance(0.5)) tap(key::kEnter);
    }

    void command() {
        const std::vector<Command>& all = workbench.commands();
        const Command& one = all[std::size_t(below(int(all.size())))];
        if (!one.available() || one.title() == "Quit") return;
        note("command " + one.title());
        one.run();
        show();
    }

    void act() {
        ++step_;
        const double dice = std::uniform_real_distribution<double>(0, 1)(random_);
        if (dice < 0.42) return moveMouse();
        if (dice < 0.68) return press();
        if (dice < 0.76) {
            wheel_ = float(below(7) - 3);
            note("wheel " + std::to_string(int(wheel_)));
            return show();
        }
        if (dice < 0.88) return type();
        if (dice < 0.93) return write();
        if (dice < 0.99) return command();
        size_ = {200 + below(900), 150 + below(600)};
        note("size " + std::to_string(size_.x) + " " + std::to_string(size_.y));
        window_.emplace(size_);
        show();
    }

    /// Memory after every layout has been shown once more and programs of others have been given back, which takes some
    /// 20 seconds: what grows from one rest to the next was lost on the way.
    void rest() {
        for (const std::string& layout : layoutNames()) {
            start(layout, {1000, 700});
            showWhile([&](double seconds) { return seconds < 1 || (workbench.busy() && seconds < 10); });
        }
        showWhile([](double seconds) { return seconds < 45; });
        report("at rest: ");
    }

    void showWhile(const std::function<bool(double seconds)>& goesOn) {
        const double begin = passedMinutes();
        while (goesOn((passedMinutes() - begin) * 60) && !HasFatalFailure()) {
            show();
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
    }

    void report(const char* what) {
        std::printf("%s%.1f min, %d inputs, %.0f MB, allocated %.0f\n", what, passedMinutes(), step_,
                    test::residentMemory(), test::allocatedMemory());
        std::fflush(stdout);
    }

    double passedMinutes() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count() / 60;
    }

    /// The state as a session file would be, and as it is when that is opened.
    void expectSameWhenReopened() {
        if (!workbench.document().loaded()) return;
        const SessionDocument now = workbench.document().snapshot();
        const std::string path = (folder_ / "state.tessera.json").string(), text = printSession(now, path);
        note("save");
        const SessionDocument again = parseSession(text, path);
        std::ofstream(path) << text; // to look at
        ASSERT_THAT(again.messages, testing::IsEmpty()) << "after input " << step_;
        ASSERT_TRUE(printSession(again, path) == text) << "after input " << step_;
    }

    const std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
    std::mt19937 random_{unsigned(numberFrom("TESSERA_MONKEY_SEED", 1))};
    std::optional<OffscreenFrames> window_;
    std::ofstream log_;
    glm::ivec2 size_{0};
    ImVec2 mouse_{100, 100};
    bool down_[3] = {}, ctrl_ = false, shift_ = false, alt_ = false, keyDown_ = false;
    int key_ = 0, step_ = 0;
    float wheel_ = 0;
    std::string text_;
};

TEST_F(Monkey, AnyInputLeavesAStateThatIsTheSameWhenReopened) {
    const double minutes = numberFrom("TESSERA_MONKEY_MINUTES", 0), restEvery = minutes / 6;
    double nextRest = restEvery;
    do {
        startAnywhere();
        const int last = step_ + (minutes > 0 ? 1000 : 300);
        while (step_ < last) {
            act();
            if (HasFatalFailure()) return;
            if (step_ % 100 != 0) continue;
            letGo();
            tap(key::kEscape);
            expectSameWhenReopened();
            if (HasFatalFailure()) return;
        }
        workbench.jobs().wait();
        report("");
        if (minutes == 0 || passedMinutes() < nextRest) continue;
        rest();
        if (HasFatalFailure()) return;
        nextRest = passedMinutes() + restEvery;
    } while (passedMinutes() < minutes);
}

} // namespace
} // namespace tessera::app
