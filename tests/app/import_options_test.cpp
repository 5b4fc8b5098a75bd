#include "app/data/import_options.h"

#include <gmock/gmock.h>

namespace tessera::app {
namespace {

TEST(ImportOptionsTest, APreviewSaysBytesAsTheWindowDoes) {
    volume::ImportPreview preview;
    preview.info.times = {0};
    preview.bytes = 1234567890;
    EXPECT_THAT(describePreview(preview), testing::HasSubstr("  size       1.23 GB\n"));
    preview.bytes = 999700;
    EXPECT_THAT(describePreview(preview), testing::HasSubstr("  size       1 MB\n"));
}

} // namespace
} // namespace tessera::app
