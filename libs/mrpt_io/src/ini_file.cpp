// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/ini_file.h>

#include <filesystem>

namespace pointplane
{
std::unique_ptr<const mrpt::config::CConfigFile> openIniFile(const std::string& path)
{
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
    {
        throw InputError("cannot open " + path + ": no such file");
    }
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
