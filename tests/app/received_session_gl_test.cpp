#include "app/user_files/machines.h"
#include "codec/remote/consent.h"
#include "tests/app/drawn_text.h"
#include "workbench_fixture.h"

#include <algorithm>
#include <arpa/inet.h>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace tessera::app {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::HasSubstr;

/// A window that opens a session which names this machine, where connections are counted and never answered.
struct ReceivedSession : DrawnWorkbench {
    ReceivedSession() : DrawnWorkbench({.stateFolder = made()}) {}
    static std::string made() {
        const fs::path folder = fs::path(testing::TempDir()) / ("received_" + std::to_string(::getpid()));
        fs::create_directories(folder);
        return folder.string();
    }
    void SetUp() override {
        codec::requireConsent([this](const std::string& name) { return isKnownMachine(folder, name); });
        workbench.install(smallData());
        settle();
        listen();
    }
    /// On a port of its own each time: a machine is allowed for as long as the process lasts.
    void listen() {
        if (listening >= 0) ::close(listening);
        listening = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
        ASSERT_GE(listening, 0);
        sockaddr_in at{};
        at.sin_family = AF_INET;
        at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof at;
        ASSERT_EQ(::bind(listening, reinterpret_cast<sockaddr*>(&at), size), 0);
        ASSERT_EQ(::listen(listening, 8), 0);
        ASSERT_EQ(::getsockname(listening, reinterpret_cast<sockaddr*>(&at), &size), 0);
        machine = "http://127.0.0.1:" + std::to_string(ntohs(at.sin_port));
        SessionDocument sent;
        sent.session = smallData().document.session;
        sent.session.data = {};
        DataFile file;
        file.path = file.absolutePath = machine + "/a.tsr";
        sent.session.data.files = {file};
        sent.session.data.remote.patience = 0;
        saveSession(sent, folder + "/sent.tessera.json");
    }
    void TearDown() override {
        codec::allowAllMachines();
        ::close(listening);
        fs::remove_all(folder);
    }
    /// Whether anybody has connected since the last call; ends the connection.
    bool wasAsked() const {
        pollfd waiting{listening, POLLIN, 0};
        bool any = false;
        while (::poll(&waiting, 1, 0) > 0) {
            any = true;
            ::close(::accept(listening, nullptr, nullptr));
        }
        return any;
    }
    void openIt() {
        OpenRequest request;
        request.paths = {folder + "/sent.tessera.json"};
        workbench.open(request);
        settle();
        for (int i = 0; i < 4; ++i) frame();
    }
    void click(const std::string& button) {
        for (const DrawnText& text : drawnTexts())
            if (text.text == button) {
                for (const bool down : {false, true, false})
                    frame([&](ImGuiIO& io) {
                        io.MousePos = text.middle();
                        io.MouseDown[0] = down;
                    });
                return;
            }
        ADD_FAILURE() << "not drawn: " << button;
    }
    std::string lastMessage() { return workbench.messages().list().back().text; }

    std::string folder = made(), machine;
    int listening = -1;
};

TEST_F(ReceivedSession, AsksNoMachineBeforeTheUserAgrees) {
    const DataRef shown = workbench.session().data;
    openIt();
    EXPECT_THAT(drawnWords(), Contains(HasSubstr(machine)));
    EXPECT_FALSE(wasAsked());
    press(key::kEnter);
    for (int i = 0; i < 4; ++i) frame();
    EXPECT_THAT(lastMessage(), HasSubstr(machine + " is not asked"));
    EXPECT_FALSE(wasAsked());
    EXPECT_TRUE(workbench.session().data == shown);
}

TEST_F(ReceivedSession, AsksTheMachineThatTheUserAllowed) {
    for (const bool always : {false, true}) {
        if (always) listen();
        openIt();
        EXPECT_FALSE(wasAsked());
        click(always ? "Always" : "Open");
        bool asked = false;
        for (int i = 0; i < 200 && !asked; ++i) {
            frame();
            ::usleep(20'000);
            asked = wasAsked();
        }
        EXPECT_TRUE(asked) << always;
        while (workbench.jobs().running("open")) { // it fails, since nobody answers
            (void)wasAsked();
            frame();
        }
        EXPECT_EQ(isKnownMachine(folder, machine), always);
    }
    ::close(listening); // the next connection is refused at once
    openIt();           // no question any more
    EXPECT_THAT(drawnWords(), testing::Not(Contains("Ask another machine?")));
}

} // namespace
} // namespace tessera::app
