// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/ImagesFolder.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/rawlog_names.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "exchange_folders.h"
#include <fcntl.h>

namespace pointplane
{
namespace fs = std::filesystem;

/** The images of a folder. \throws EnvironmentError if there is anything else in it */
std::vector<fs::path> ImagesFolder::imagesOf(const std::string& folder) const
{
    std::vector<fs::path> out;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error))
    {
        const std::string name = entry->path().filename().string();
        if (!entry->is_regular_file() || entry->is_symlink() || !own_.include(entry->path()))
        {
            throw EnvironmentError(
                "cannot replace " + folder + ": it holds '" + name + "', which is no " + own_.kind +
                "; move that elsewhere");
        }
        out.push_back(entry->path());
    }
    if (error)
    {
        throw EnvironmentError("cannot read " + folder + ": " + error.message());
    }
    return out;
}

void ImagesFolder::removeImages(const std::string& folder) const
{
    for (const fs::path& image : imagesOf(folder))
    {
        fs::remove(image);
    }
}

ImagesFolder::ImagesFolder(const std::string& path, OwnImages own) : own_(std::move(own))
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
    if (fs::is_symlink(partial_))
    {
        throw EnvironmentError(
            "cannot create " + partial_ + ": something else has this name; remove it");
    }
    folder_.emplace(partial_);
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
        isDone = exchangeInSteps(path_, partial_);
    }
    if (!isDone)
    {
        throw EnvironmentError("cannot rename " + partial_ + ": " + std::strerror(errno));
    }
    isInPlace_ = !isInPlace_;
}

void ImagesFolder::completeWith(const std::function<void()>& completeRawlog)
{
    exchange();
    try
    {
        completeRawlog();
    }
    catch (...)
    {
        exchange();  // the earlier rawlog is still there
        throw;
    }
    removePartial();
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
