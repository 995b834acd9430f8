// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/OutputFile.h>
#include <pointplane/mrpt_io/errors.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace pointplane
{
namespace
{
namespace fs = std::filesystem;

/** Whether this open stream and this name are the same file. */
[[nodiscard]] bool leadsTo(int fd, const std::string& path)
{
    struct stat named = {}, open = {};
    return ::stat(path.c_str(), &named) == 0 && ::fstat(fd, &open) == 0 &&
           open.st_dev == named.st_dev && open.st_ino == named.st_ino;
}

/** Standard output or error, if it goes to this very file: renaming would take it away, and to open
 * it anew would be to write over what the stream writes. \return -1: neither does */
[[nodiscard]] int standardStreamTo(const std::string& path)
{
    for (const int fd : {STDOUT_FILENO, STDERR_FILENO})
    {
        if (leadsTo(fd, path))
        {
            return fd;
        }
    }
    return -1;
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
[[nodiscard]] EnvironmentError cannot(const std::string& action, const std::string& path)
{
    return EnvironmentError("cannot " + action + " " + path + ": " + std::strerror(errno));
}

/** Closes what is not taken over. */
class Descriptor
{
 public:
    explicit Descriptor(int fd) : fd_(fd) {}
    ~Descriptor()
    {
        if (fd_ >= 0)
        {
            ::close(fd_);
        }
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    [[nodiscard]] int get() const { return fd_; }
    [[nodiscard]] int release() { return std::exchange(fd_, -1); }

 private:
    int fd_;
};

/** Opens a partial file for this program alone, empty, and without following a link: what has this
 * name and is something else, or another name of something else, is not ours to write to.
 * \return -1 if another program has just completed it */
[[nodiscard]] int tryOpenPartial(const std::string& path)
{
    Descriptor file(
        ::open(path.c_str(), O_WRONLY | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666));
    struct stat info = {};
    const bool isOpen = file.get() >= 0 && ::fstat(file.get(), &info) == 0;
    if (isOpen ? !S_ISREG(info.st_mode) || info.st_nlink > 1 : errno == ELOOP || errno == ENXIO)
    {
        throw EnvironmentError(
            "cannot create " + path + ": something else has this name; remove it");
    }
    if (!isOpen)
    {
        throw cannot("create", path);
    }
    if (::flock(file.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    {
        throw EnvironmentError("cannot create " + path + ": another program is writing it");
    }
    struct stat named = {};
    if (::stat(path.c_str(), &named) != 0 || named.st_ino != info.st_ino ||
        named.st_dev != info.st_dev)
    {
        return -1;
    }
    if (::ftruncate(file.get(), 0) != 0)
    {
        throw cannot("create", path);
    }
    return file.release();
}

[[nodiscard]] int openPartial(const std::string& path)
{
    int fd = -1;
    while (fd < 0)
    {
        fd = tryOpenPartial(path);
    }
    return fd;
}
}  // namespace

OutputTarget outputTarget(const std::string& path)
{
    struct stat info = {};
    const bool exists = ::stat(path.c_str(), &info) == 0;
    if (exists && (!S_ISREG(info.st_mode) || standardStreamTo(path) >= 0))
    {
        return {path, false};
    }
    return {followed(path).string(), true};
}

bool isStandardOutput(const std::string& path)
{
    struct stat info = {};
    return ::stat(path.c_str(), &info) == 0 && !S_ISCHR(info.st_mode) &&
           leadsTo(STDOUT_FILENO, path);
}

OutputFile::OutputFile(const std::string& path) : path_(path), target_(outputTarget(path))
{
    const int stream = standardStreamTo(path);
    fd_ = target_.isReplaced ? openPartial(writtenPath())
          : stream >= 0      ? ::fcntl(stream, F_DUPFD_CLOEXEC, 0)
                             : ::open(target_.path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
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

void OutputFile::fail(const char* action) const { throw cannot(action, writtenPath()); }

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
    commitUnsynced();
}

void OutputFile::commitUnsynced()
{
    // Before it is closed: until then, no other program writes to it.
    if (target_.isReplaced && std::rename(writtenPath().c_str(), target_.path.c_str()) != 0)
    {
        fail("rename");
    }
    if (::close(std::exchange(fd_, -1)) != 0)
    {
        fail("write");
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
