// SPDX-License-Identifier: BSD-3-Clause
#include "output_checks.h"

#include <pointplane/mrpt_io/OutputFile.h>
#include <pointplane/mrpt_io/errors.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "standard_streams.h"
#include <unistd.h>

namespace pointplane
{
namespace
{
namespace fs = std::filesystem;

[[nodiscard]] fs::path folderOf(const fs::path& path)
{
    return path.parent_path().empty() ? "." : path.parent_path();
}

/** The nearest folder on the way to `path` that is there. */
[[nodiscard]] fs::path existingFolder(fs::path path)
{
    std::error_code error;
    while (!fs::exists(path, error) && path.has_relative_path())
    {
        path = folderOf(path);
        if (path == ".")
        {
            break;
        }
    }
    return path;
}

[[noreturn]] void failToWrite(const std::string& option, const std::string& path)
{
    throw EnvironmentError(option + ": cannot write " + path + ": " + std::strerror(errno));
}
}  // namespace

void requireShortName(
    const std::string& option, const std::string& path, const std::string& written)
{
    const long most = ::pathconf(existingFolder(folderOf(written)).c_str(), _PC_NAME_MAX);
    const std::string name = fs::path(written).filename().string();
    if (most > 0 && name.size() > static_cast<std::size_t>(most))
    {
        throw InputError(
            option + " " + path + ": needs a name of " + std::to_string(name.size()) +
            " bytes while it is written, but " + std::to_string(most) +
            " are the most; give a shorter one");
    }
}

void requireWritableFile(const std::string& option, const std::string& path)
{
    if (path == "-")
    {
        throw InputError(
            option + " -: give /dev/stdout for the standard output, ./- for a file of this name");
    }
    std::error_code error;
    const auto status = fs::status(path, error);
    if (fs::is_directory(status) || path.back() == '/')
    {
        throw InputError(option + " " + path + ": is a folder; give the name of a file");
    }
    if (fs::is_block_file(status))
    {
        throw InputError(option + " " + path + ": is a disk; give the name of a file");
    }
    if (isStandardOutput(path))
    {
        requireStandardOutput();
    }
    const OutputTarget target = outputTarget(path);
    requireShortName(option, path, target.writtenPath());
    if (const fs::path folder = folderOf(target.path);
        fs::status(folder, error).type() == fs::file_type::not_found)
    {
        throw EnvironmentError(
            option + ": cannot write " + path + ": there is no folder " + folder.string());
    }
    // The file and, where it is made anew, its folder.
    if ((fs::exists(status) && ::access(path.c_str(), W_OK) != 0) ||
        (target.isReplaced && ::access(folderOf(target.path).c_str(), W_OK | X_OK) != 0))
    {
        failToWrite(option, path);
    }
}

void requireWritableFolder(const std::string& option, const std::string& path)
{
    const fs::path folder = existingFolder(path);
    std::error_code error;
    if (!fs::is_directory(folder, error))
    {
        throw InputError(option + " " + path + ": " + folder.string() + " is not a folder");
    }
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
    {
        failToWrite(option, path);
    }
}
}  // namespace pointplane
