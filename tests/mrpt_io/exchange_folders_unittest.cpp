// SPDX-License-Identifier: BSD-3-Clause
#include "exchange_folders.h"

#include <cerrno>
#include <filesystem>

#include "TempDir.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
namespace fs = std::filesystem;

TEST(ExchangeInSteps, bothFoldersHaveTheOthersName)
{
    const test::TempDir dir;
    fs::create_directories(dir / "a/of_a");
    fs::create_directories(dir / "b/of_b");
    EXPECT_TRUE(exchangeInSteps(dir / "a", dir / "b"));
    EXPECT_TRUE(fs::exists(dir / "a/of_b"));
    EXPECT_TRUE(fs::exists(dir / "b/of_a"));
    EXPECT_FALSE(fs::exists(dir / "a.earlier"));
}

TEST(ExchangeInSteps, aFailureLeavesTheEarlierFolderInItsPlace)
{
    const test::TempDir dir;
    fs::create_directories(dir / "a/of_a");
    EXPECT_FALSE(exchangeInSteps(dir / "a", dir / "none"));
    EXPECT_EQ(errno, ENOENT);
    EXPECT_TRUE(fs::exists(dir / "a/of_a"));
    EXPECT_FALSE(fs::exists(dir / "a.earlier"));
}
}  // namespace
}  // namespace pointplane
