#include "codec/remote/consent.h"
#include "codec/remote/login.h"
#include "codec/remote/remote_file.h"

#include <cctype>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <string>

namespace tessera::codec {
namespace {

bool isAddress(const std::string& text) {
    try {
        (void)parseAddress(text);
        return true;
    } catch (const Error&) {
        return false;
    }
}

// What reaches ssh, libcurl and a line that may be copied into a shell has no character that one of them could take for
// something else.
TEST(Addresses, HostsAndUsersHaveNoOtherCharacters) {
    for (int byte = 0; byte < 256; ++byte) {
        const std::string c(1, static_cast<char>(byte));
        const bool plain = byte < 128 && (std::isalnum(byte) != 0 || std::string("._-").find(c) != std::string::npos);
        for (const char* const scheme : {"http://", "https://", "sftp://"}) {
            if (byte != '/' && byte != '@') { // these end the host, or begin it
                EXPECT_EQ(isAddress(scheme + ("a" + c) + "b/c.tsr"), plain) << byte;
            }
            if (byte != '/' && byte != '%') {
                EXPECT_EQ(isAddress(scheme + ("a" + c) + "b@host/c.tsr"), plain) << byte;
            }
        }
        char code[4];
        std::snprintf(code, sizeof code, "%%%02X", unsigned(byte));
        EXPECT_EQ(isAddress("sftp://a" + std::string(code) + "b@host/c.tsr"), plain) << byte;
        EXPECT_FALSE(isAddress("http://a" + std::string(code) + "b/c.tsr"));
    }
    EXPECT_TRUE(isAddress("http://[2001:db8::1]:80/a"));
    for (const char* const bad :
         {"http://[::1/a", "http://2001:db8::1/a", "http://[a b]/a", "http://[]/a", "http://[-x]/a", "http://a:65536/b",
          "http://a:99999/b", "sftp://@a/b", "http://good\\@bad/a", "http://good#@bad/a", "sftp://-oProxyCommand=x/a"})
        EXPECT_FALSE(isAddress(bad)) << bad;
}

TEST(Consent, IsGivenToMachinesWhateverTheUserAndThePath) {
    EXPECT_EQ(machineOf(parseAddress("HTTPS://Data.Example.org:8443/a?b")), "https://data.example.org:8443");
    EXPECT_EQ(machineOf(parseAddress("sftp://me@cluster/~/a.tsr")), "sftp://cluster");
    EXPECT_EQ(machineOf(parseAddress("http://[::1]:80/a")), "http://[::1]:80");
}

/// Ends what a test demands.
class ConsentTest : public ::testing::Test {
protected:
    void TearDown() override { allowAllMachines(); }
    /// What opening says: of port 1 of this machine, where nobody answers.
    static std::string opened(const std::string& address) {
        RemoteOptions options;
        options.patience = 0;
        try {
            (void)RemoteFile(address, options);
        } catch (const NotAllowed& error) {
            return "not allowed: " + error.machine();
        } catch (const Error&) {
            return "asked";
        }
        return "opened";
    }
};

TEST_F(ConsentTest, WithoutItNoMachineIsAsked) {
    const std::string address = "http://127.0.0.1:1/a.tsr", machine = "http://127.0.0.1:1";
    EXPECT_EQ(opened(address), "asked") << "programs that ask nobody may ask every machine";
    std::vector<std::string> questions;
    bool isKnown = false;
    requireConsent([&](const std::string& name) {
        questions.push_back(name);
        return isKnown;
    });
    EXPECT_EQ(opened(address), "not allowed: " + machine);
    EXPECT_EQ(opened("sftp://127.0.0.1:1/a.tsr"), "not allowed: sftp://127.0.0.1:1");
    EXPECT_EQ(questions, (std::vector<std::string>{machine, "sftp://127.0.0.1:1"}));
    allowMachine(machine);
    EXPECT_EQ(opened(address), "asked");
    EXPECT_EQ(opened("http://127.0.0.1:2/a.tsr"), "not allowed: http://127.0.0.1:2") << "another port, another server";
    EXPECT_EQ(opened("https://127.0.0.1:1/a.tsr"), "not allowed: https://127.0.0.1:1");
    isKnown = true;
    EXPECT_EQ(opened("http://127.0.0.1:2/a.tsr"), "asked");
    EXPECT_FALSE(RemoteHeaders("http://127.0.0.1:3/a.tsr").read({}));
}

std::string login(const std::string& netrc, const std::string& host, const std::string& user = {}) {
    const auto found = loginFor(netrc, host, user);
    return found ? found->user + ":" + found->password : "none";
}

TEST(Logins, AreThoseOfTheVeryHost) {
    const std::string netrc = "# machine c login x password y\n"
                              "machine a.org login me password \"two \\\"words\\\"\"\n"
                              "machine B.org\n  account z\n  login you\n  password #1\n"
                              "machine a.org login other password second\n"
                              "macdef init\nmachine d login x password y\n\n"
                              "machine e password alone\n";
    EXPECT_EQ(login(netrc, "a.org"), "me:two \"words\"");
    EXPECT_EQ(login(netrc, "a.org", "other"), "other:second");
    EXPECT_EQ(login(netrc, "a.org", "nobody"), "none");
    EXPECT_EQ(login(netrc, "b.ORG"), "you:#1");
    EXPECT_EQ(login(netrc, "e"), ":alone");
    for (const char* const host : {"c", "d", "org", "a.org.evil", "", "login"}) EXPECT_EQ(login(netrc, host), "none");
}

TEST(Logins, TheDefaultEntryIsForNobody) {
    for (const char* const netrc :
         {"default login me password secret", "machine a login x password y\ndefault login me password secret\n",
          "default\nlogin me\npassword secret\nmachine a login x password y"})
        for (const char* const user : {"", "me"}) EXPECT_EQ(login(netrc, "evil.example", user), "none") << netrc;
    EXPECT_EQ(login("machine a login x password y default login me password secret", "a"), "x:y");
    EXPECT_EQ(login("machine a default login me password secret", "a"), ":") << "nothing of the entry after it";
}

} // namespace
} // namespace tessera::codec
