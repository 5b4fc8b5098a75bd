#pragma once

#include "app/data/open.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace tessera::app {

/// A folder for the files that a test opens.
class OpenTest : public ::testing::Test {
protected:
    void SetUp() override {
        folder =
            std::filesystem::temp_directory_path() / ("tessera-open-" + std::to_string(getpid()) + "-" +
                                                      ::testing::UnitTest::GetInstance()->current_test_info()->name());
        std::filesystem::create_directories(folder);
    }
    void TearDown() override { std::filesystem::remove_all(folder); }
    std::string in(const std::string& name) const { return (folder / name).string(); }
    std::string raw(const std::string& name) const {
        std::ofstream(folder / name, std::ios::binary) << std::string(5 * 6 * 7, '\x21') + std::string(210, '\x42');
        return in(name);
    }
    static OpenRequest rawRequest(const std::string& path) {
        OpenRequest request;
        request.paths = {path};
        request.import.emplace();
        request.import->raw = "dims=5x6x14,type=u8";
        return request;
    }
    std::filesystem::path folder;
};

} // namespace tessera::app
