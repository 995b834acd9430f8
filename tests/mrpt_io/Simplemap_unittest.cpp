// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/SimplemapReader.h>
#include <pointplane/mrpt_io/SimplemapWriter.h>

#include "TempDir.h"
#include "rawlog_samples.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
TEST(Simplemap, endsOnceAndStaysWhole)
{
    const test::TempDir dir;
    SimplemapWriter writer(dir / "a.simplemap");
    writer.add({}, test::sampleScan(0));
    writer.close();
    writer.close();  // as RawlogWriter's

    SimplemapReader reader(dir / "a.simplemap");
    EXPECT_TRUE(reader.next());
    EXPECT_FALSE(reader.next());
    EXPECT_FALSE(reader.next());
}

TEST(Simplemap, aScanOfColourAloneHasNoPoints)
{
    const auto scan = test::sampleScan(0);
    scan->hasRangeImage = false;
    EXPECT_FALSE(withPoints(*scan)->hasPoints3D);
    EXPECT_TRUE(withPoints(*test::sampleScan(0))->hasPoints3D);
}

TEST(Simplemap, saturatedDepthGivesNoPoint)
{
    const auto scan = test::sampleScan(0);
    scan->rangeImage(3, 4) = 0;
    scan->rangeImage(5, 6) = 65535;
    const std::size_t numReadings = scan->rangeImage.size() - 2;
    EXPECT_EQ(withPoints(*scan)->points3D_x.size(), numReadings);
    EXPECT_EQ(scan->rangeImage(5, 6), 65535) << "the scan itself stays";
}

TEST(Simplemap, aKeyFrameWithoutScanIsRefusedWhereItIsAdded)
{
    const test::TempDir dir;
    SimplemapWriter writer(dir / "a.simplemap");
    EXPECT_THROW(writer.add({}, nullptr), std::invalid_argument);
    EXPECT_EQ(writer.size(), 0U);
    writer.discard();
}
}  // namespace
}  // namespace pointplane
