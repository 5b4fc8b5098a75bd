#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <span>
#include <stdexcept>
#include <string>
#include <unistd.h>

namespace tessera::test {

/// A program named ssh, first on PATH, that prints what it is given as the answers of an sftp server. Its folder is
/// removed at the end.
class FakeSsh {
public:
    FakeSsh() {
        const std::filesystem::path program = folder / "ssh";
        std::ofstream(program) << "#!/bin/sh\nexec cat '" << (folder / "answers").string() << "'\n";
        std::filesystem::permissions(program, std::filesystem::perms::owner_all);
        ::setenv("PATH", (folder.string() + ":" + before_).c_str(), 1);
    }
    ~FakeSsh() {
        ::setenv("PATH", before_.c_str(), 1);
        std::error_code ignored;
        std::filesystem::remove_all(folder, ignored);
    }
    FakeSsh(const FakeSsh&) = delete;
    FakeSsh& operator=(const FakeSsh&) = delete;

    void answer(std::span<const std::byte> bytes) const {
        std::ofstream(folder / "answers", std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    }

    const std::filesystem::path folder = newFolder();

private:
    /// A new folder that only this user can enter: a program in it is run.
    static std::filesystem::path newFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "tessera-ssh-XXXXXX").string();
        if (!::mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
        return name;
    }

    const std::string before_ = std::getenv("PATH") ? std::getenv("PATH") : "/usr/bin:/bin";
};

} // namespace tessera::test
