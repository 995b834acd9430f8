// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/OutputFile.h>
#include <pointplane/mrpt_io/errors.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace pointplane
{
namespace
{
namespace fs = std::filesystem;

/** Standard output or error, redirected to this very file: renaming would take it away. */
[[nodiscard]] bool isStandardStream(const struct stat& info)
{
    for (const int fd : {STDOUT_FILENO, STDERR_FILENO})
    {
        struct stat own = {};
        if (::fstat(fd, &own) == 0 && own.st_dev == info.st_dev && own.st_ino == info.st_ino)
        {
            return true;
        }
    }
    return false;
}

/** Also a link to nothing: it is its target that gets created. */
[[nodiscard]] fs::path followed(fs::path path)
{
    constexpr int kMaxLinks = 40;  // as the kernel
    std::error_code error;
    for (int i = 0; i < kMaxLinks && fs::is_symlink(path, error); ++i)
    {
        const fs::path to = fs::read_symlink(path, error);
        path = to.is_absolute() ? to : path.parent_path() / to;
    }
    return path;
}
}  // namespace

OutputTarget outputTarget(const std::string& path)
{
    struct stat info = {};
    const bool exists = ::stat(path.c_str(), &info) == 0;
    if (exists && (!S_ISREG(info.st_mode) || isStandardStream(info)))
    {
        return {path, false};
    }
    return {followed(path).string(), true};
}

OutputFile::OutputFile(const std::string& path) : path_(path), target_(outputTarget(path))
{
    // A standard stream's own writes follow ours.
    const int mode = target_.isReplaced ? O_CREAT | O_TRUNC : O_APPEND;
    fd_ = ::open(writtenPath().c_str(), O_WRONLY | O_CLOEXEC | mode, 0666);
    if (fd_ < 0)
    {
        fail("create");
    }
    struct stat earlier = {};
    if (target_.isReplaced && ::stat(target_.path.c_str(), &earlier) == 0)
    {
        (void)!::fchmod(fd_, earlier.st_mode & 07777);
    }
}

OutputFile::~OutputFile()
{
    if (fd_ >= 0)
    {
        ::close(fd_);
    }
}

void OutputFile::fail(const char* action) const
{
    throw EnvironmentError(
        std::string("cannot ") + action + " " + writtenPath() + ": " + std::strerror(errno));
}

void OutputFile::write(const void* data, std::size_t size)
{
    const auto* bytes = static_cast<const std::uint8_t*>(data);
    while (size > 0)
    {
        const ssize_t n = ::write(fd_, bytes, size);
        if (n < 0 && errno == EINTR)
        {
            continue;
        }
        if (n < 0)
        {
            fail("write");
        }
        bytes += n;
        size -= static_cast<std::size_t>(n);
    }
}

void OutputFile::commit()
{
    if (fd_ < 0)
    {
        return;
    }
    // EINVAL, EROFS: a pipe or a device, where there is nothing to wait for.
    if (::fsync(fd_) != 0 && errno != EINVAL && errno != EROFS)
    {
        fail("write");
    }
    const int fd = fd_;
    fd_ = -1;
    if (::close(fd) != 0)
    {
        fail("write");
    }
    if (target_.isReplaced && std::rename(writtenPath().c_str(), target_.path.c_str()) != 0)
    {
        fail("rename");
    }
}

void OutputFile::discard() noexcept
{
    if (fd_ >= 0 && target_.isReplaced)
    {
        ::unlink(writtenPath().c_str());
    }
}
}  // namespace pointplane
