// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/trimmed.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/ini_file.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <set>

namespace pointplane
{
namespace
{
/** MRPT takes upper and lower case for the same. */
[[nodiscard]] std::string inLowerCase(std::string text)
{
    std::transform(
        text.begin(),
        text.end(),
        text.begin(),
        [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/** MRPT silently takes the last of several. */
void refuseRepeatedKeys(const std::string& path)
{
    std::ifstream file(path);
    std::set<std::string> seen;
    std::string section;
    int number = 1;
    for (std::string line; std::getline(file, line); ++number)
    {
        const std::string content = trimmed(line);
        const std::size_t equals = content.find('=');
        if (content.rfind("@if", 0) == 0)
        {
            return;  // of its branches, one counts
        }
        if (!content.empty() && content.front() == '[')
        {
            section = trimmed(content.substr(1, content.find(']') - 1));
        }
        else if (
            equals != std::string::npos &&
            std::string("#;/@").find(content[0]) == std::string::npos)
        {
            const std::string key = trimmed(content.substr(0, equals));
            if (!seen.insert(inLowerCase(section + "]" + key)).second)
            {
                throw InputError(
                    path + ":" + std::to_string(number) + ": key '" + key + "' appears twice in [" +
                    section + "]; remove one");
            }
        }
    }
}
}  // namespace

std::unique_ptr<const mrpt::config::CConfigFile> openIniFile(const std::string& path)
{
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
    {
        throw InputError("cannot open " + path + ": " + whyNoFile(path));
    }
    refuseRepeatedKeys(path);
    try
    {
        return std::make_unique<const mrpt::config::CConfigFile>(path);
    }
    catch (const std::exception& e)
    {
        throw InputError(path + ": " + oneLine(e));
    }
}
}  // namespace pointplane
