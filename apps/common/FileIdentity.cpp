// SPDX-License-Identifier: BSD-3-Clause
#include "FileIdentity.h"

#include <pointplane/mrpt_io/OutputFile.h>

#include <filesystem>

#include <sys/stat.h>

namespace pointplane
{
FileIdentity::FileIdentity(const std::string& name)
{
    namespace fs = std::filesystem;
    std::error_code error;
    // Of a relative name of which nothing is there yet, weakly_canonical() leaves a relative one.
    const fs::path full = fs::absolute(outputTarget(name).path, error);
    const fs::path real = fs::weakly_canonical(full, error);
    path = error ? full.string() : real.string();
    if (path.size() > 1 && path.back() == '/')
    {
        path.pop_back();
    }
    struct stat info = {};
    if (::stat(name.c_str(), &info) == 0)
    {
        device = info.st_dev;
        inode = info.st_ino;
    }
}

bool FileIdentity::isSame(const FileIdentity& other) const
{
    return path == other.path || (inode != 0 && inode == other.inode && device == other.device);
}

bool FileIdentity::isIn(const FileIdentity& folder) const
{
    return path.size() > folder.path.size() && path[folder.path.size()] == '/' &&
           path.compare(0, folder.path.size(), folder.path) == 0;
}
}  // namespace pointplane
