#include "volume/base/byte_text.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

TEST(TextOfBytes, HasThreeDigitsAndAUnit) {
    EXPECT_EQ(textOfBytes(0), "0 B");
    EXPECT_EQ(textOfBytes(999), "999 B");
    EXPECT_EQ(textOfBytes(1000), "1 kB");
    EXPECT_EQ(textOfBytes(12340000), "12.3 MB");
    EXPECT_EQ(textOfBytes(999499), "999 kB");
    EXPECT_EQ(textOfBytes(999700), "1 MB"); // not 1e+03 kB
    EXPECT_EQ(textOfBytes(3.2e9), "3.2 GB");
    EXPECT_EQ(textOfBytes(2.5e15), "2500 TB");
}

} // namespace
} // namespace tessera
