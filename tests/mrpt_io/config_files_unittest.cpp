// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/params_ini.h>

#include <filesystem>
#include <string>

#include "TempDir.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
const std::string kRoot = POINTPLANE_SOURCE_DIR;

TEST(ConfigFiles, configIniIsTheDumpedDefault)
{
    OdometryParams params;
    EXPECT_EQ(test::readBytes(kRoot + "/config.ini"), iniText(parametersOf(params)))
        << "run docs/update_config.sh";
}

TEST(ConfigFiles, theDocumentedKeysAreThoseOfTheProgram)
{
    OdometryParams params;
    const std::string page = test::readBytes(kRoot + "/docs/config.md");
    const std::string begin = "<!-- keys begin -->\n", end = "<!-- keys end -->\n";
    const std::size_t first = page.find(begin), last = page.find(end);
    ASSERT_NE(first, std::string::npos);
    ASSERT_NE(last, std::string::npos);
    EXPECT_EQ(
        page.substr(first + begin.size(), last - first - begin.size()),
        markdownText(parametersOf(params)))
        << "run docs/update_config.sh";
}

TEST(ConfigFiles, thePapersConfigurationIsValid)
{
    const std::string path = kRoot + "/config-paper.ini";
    ASSERT_TRUE(std::filesystem::exists(path)) << path;
    OdometryParams paper = loadOdometryParams(path);
    OdometryParams defaults;
    EXPECT_NE(iniText(parametersOf(paper)), iniText(parametersOf(defaults)));
}
}  // namespace
}  // namespace pointplane
