// SPDX-License-Identifier: BSD-3-Clause
#include "ImagesFolder.h"

#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/rawlog_names.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <vector>

#include <fcntl.h>

namespace pointplane
{
namespace
{
namespace fs = std::filesystem;

/** Whether the name is one that ScanWriter gives: a stamp, and `_rgb.png` or `_depth.bin`. */
[[nodiscard]] bool isImageName(const std::string& name)
{
    const std::size_t end = name.find_first_not_of("0123456789.-");
    return end != 0 && end != std::string::npos &&
           (name.compare(end, 5, "_rgb.") == 0 ||
            name.compare(end, std::string::npos, "_depth.bin") == 0);
}

/** The images of a folder. \throws EnvironmentError if there is anything else in it */
[[nodiscard]] std::vector<fs::path> imagesOf(const std::string& folder)
{
    std::vector<fs::path> out;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error))
    {
        const std::string name = entry->path().filename().string();
        if (!entry->is_regular_file() || entry->is_symlink() || !isImageName(name))
        {
            throw EnvironmentError(
                "cannot replace " + folder + ": it holds '" + name +
                "', which is no image of a rawlog; move that elsewhere");
        }
        out.push_back(entry->path());
    }
    if (error)
    {
        throw EnvironmentError("cannot read " + folder + ": " + error.message());
    }
    return out;
}

void removeImages(const std::string& folder)
{
    for (const fs::path& image : imagesOf(folder))
    {
        fs::remove(image);
    }
}
}  // namespace

ImagesFolder::ImagesFolder(const std::string& path)
{
    std::error_code error;
    const fs::path real = fs::weakly_canonical(path, error);  // a link stays where it leads
    path_ = error ? path : real.string();
    partial_ = partialFolderOf(path_);
    isReplaced_ = fs::exists(path_);
    if (isReplaced_ && !fs::is_directory(path_))
    {
        throw EnvironmentError("cannot create " + path_ + ": a file has this name");
    }
    if (isReplaced_)
    {
        (void)imagesOf(path_);
    }
    fs::create_directories(partial_, error);
    if (error)
    {
        throw EnvironmentError("cannot create " + partial_ + ": " + error.message());
    }
    removeImages(partial_);
}

void ImagesFolder::exchange()
{
    const auto rename = [](const std::string& from, const std::string& to, unsigned flags)
    { return ::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), flags) == 0; };
    bool isDone = false;
    if (!isReplaced_)
    {
        isDone = isInPlace_ ? rename(path_, partial_, 0) : rename(partial_, path_, 0);
    }
    else if (
        !(isDone = rename(partial_, path_, RENAME_EXCHANGE)) &&
        (errno == EINVAL || errno == ENOSYS))
    {
        // Disks of a network cannot exchange: the earlier folder steps aside.
        const std::string aside = path_ + ".earlier";
        isDone =
            rename(path_, aside, 0) && rename(partial_, path_, 0) && rename(aside, partial_, 0);
    }
    if (!isDone)
    {
        throw EnvironmentError("cannot rename " + partial_ + ": " + std::strerror(errno));
    }
    isInPlace_ = !isInPlace_;
}

void ImagesFolder::removePartial() noexcept
{
    try
    {
        if (fs::is_directory(partial_))
        {
            removeImages(partial_);
            fs::remove(partial_);
        }
    }
    catch (const std::exception&)  // it is marked as partial in any case
    {
    }
}
}  // namespace pointplane
