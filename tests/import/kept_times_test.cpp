// What tessera-import keeps of files it has read.
#include "app/importer/kept_times.h"

#include <gtest/gtest.h>
#include <vtkDoubleArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>

namespace tessera::importer {
namespace {

/// A block of so many kilobytes, named after the time it is of.
std::vector<Block> blockOf(int time, int kilobytes) {
    vtkNew<vtkImageData> image;
    vtkNew<vtkDoubleArray> numbers;
    numbers->SetNumberOfTuples(128 * vtkIdType(kilobytes));
    numbers->SetName("T");
    image->GetPointData()->AddArray(numbers);
    return {{std::to_string(time), image.Get(), {}}};
}

TEST(KeptTimes, ALongSeriesOfSmallFilesIsKeptWhole) {
    KeptTimes kept(512 * 1024);
    constexpr int kTimes = 2000;
    for (int t = 0; t < kTimes; ++t)
        EXPECT_EQ(kept.add(std::size_t(t), 0, blockOf(t, 1)).front().name, std::to_string(t));
    for (int parameter = 0; parameter < 2; ++parameter) // each asks for all times
        for (int t = 0; t < kTimes; ++t) {
            const std::vector<Block>* const blocks = kept.find(std::size_t(t), 0);
            ASSERT_NE(blocks, nullptr) << t;
            EXPECT_EQ(blocks->front().name, std::to_string(t));
        }
    EXPECT_EQ(kept.find(0, 1), nullptr);
}

TEST(KeptTimes, WhatWasAskedForLongestAgoIsDropped) {
    KeptTimes kept(1100);
    for (int t = 0; t < 3; ++t) kept.add(7, t, blockOf(t, 300));
    ASSERT_NE(kept.find(7, 0), nullptr); // the most recent now
    kept.add(7, 3, blockOf(3, 300));
    EXPECT_EQ(kept.find(7, 1), nullptr);
    for (const int t : {0, 2, 3}) EXPECT_NE(kept.find(7, t), nullptr) << t;
    kept.add(7, 4, blockOf(4, 2000)); // larger than the bound: alone
    for (const int t : {0, 2, 3}) EXPECT_EQ(kept.find(7, t), nullptr) << t;
    ASSERT_NE(kept.find(7, 4), nullptr);
    kept.keepLatest(0);
    EXPECT_EQ(kept.find(7, 4), nullptr);
    for (int t = 0; t < 3; ++t) kept.add(8, t, blockOf(t, 300));
    kept.keepLatest(2);
    EXPECT_EQ(kept.find(8, 0), nullptr);
    EXPECT_NE(kept.find(8, 1), nullptr);
    EXPECT_NE(kept.find(8, 2), nullptr);
}

} // namespace
} // namespace tessera::importer
