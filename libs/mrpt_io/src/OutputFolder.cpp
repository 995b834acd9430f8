// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/OutputFolder.h>
#include <pointplane/mrpt_io/errors.h>

#include <cerrno>
#include <filesystem>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace pointplane
{
namespace fs = std::filesystem;

OutputFolder::OutputFolder(const std::string& path) : path_(path)
{
    std::error_code error;
    isNew_ = fs::create_directories(path, error);
    if (error)
    {
        throw EnvironmentError("cannot create " + path + ": " + error.message());
    }
    // One that may not be read cannot be locked, but written to.
    fd_ = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd_ >= 0 && ::flock(fd_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    {
        ::close(fd_);
        throw EnvironmentError("cannot write into " + path + ": another program is writing there");
    }
}

OutputFolder::~OutputFolder()
{
    if (fd_ >= 0)
    {
        ::close(fd_);
    }
}

void OutputFolder::removeIfNew() noexcept
{
    if (isNew_)
    {
        ::rmdir(path_.c_str());  // does nothing to one that holds anything
    }
}

std::string OutputFolder::fileAt(const std::string& name) const
{
    const fs::path path = fs::path(path_) / name;
    std::error_code error;
    if (fs::is_symlink(path, error) && !fs::remove(path, error) && error)
    {
        throw EnvironmentError("cannot replace the link " + path.string() + ": " + error.message());
    }
    return path.string();
}
}  // namespace pointplane
