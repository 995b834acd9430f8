// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/grabber/DurableFile.h>
#include <pointplane/mrpt_io/errors.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include <fcntl.h>
#include <unistd.h>

namespace pointplane
{
namespace
{
std::string parentFolder(const std::string& path)
{
    const auto parent = std::filesystem::path(path).parent_path();
    return parent.empty() ? "." : parent.string();
}

/** \return 0 or the error number */
int writeAll(int fd, const void* data, std::size_t numBytes)
{
    const auto* bytes = static_cast<const char*>(data);
    while (numBytes > 0)
    {
        const ssize_t written = ::write(fd, bytes, numBytes);
        if (written < 0 && errno == EINTR)
        {
            continue;
        }
        if (written <= 0)
        {
            return written < 0 ? errno : EIO;
        }
        bytes += written;
        numBytes -= static_cast<std::size_t>(written);
    }
    return 0;
}
}  // namespace

DurableFile::DurableFile(std::string path) : path_(std::move(path))
{
    fd_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    if (fd_ < 0 && errno == EEXIST)
    {
        throw InputError("'" + path_ + "' exists already; recordings never overwrite");
    }
    if (fd_ < 0)
    {
        fail("cannot create", errno);
    }
    syncFolder(parentFolder(path_));  // the name, too, must survive
}

DurableFile::~DurableFile()
{
    if (fd_ >= 0)
    {
        ::close(fd_);
    }
}

void DurableFile::fail(const char* what, int error) const
{
    throw EnvironmentError(std::string(what) + " '" + path_ + "': " + std::strerror(error));
}

void DurableFile::append(const void* data, std::size_t numBytes)
{
    if (const int error = writeAll(fd_, data, numBytes); error != 0)
    {
        const auto end = static_cast<off_t>(numBytes_);
        if (::ftruncate(fd_, end) != 0 || ::lseek(fd_, end, SEEK_SET) != end)
        {
            fail("cannot take back an incomplete record of", errno);
        }
        fail("cannot write", error);
    }
    numBytes_ += numBytes;
}

void DurableFile::sync()
{
    if (::fdatasync(fd_) != 0)
    {
        fail("cannot write", errno);
    }
}

void DurableFile::close()
{
    sync();
    const int fd = fd_;
    fd_ = -1;
    if (::close(fd) != 0)
    {
        fail("cannot close", errno);
    }
}

void writeFile(const std::string& path, const void* data, std::size_t numBytes)
{
    const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    int error = fd < 0 ? errno : writeAll(fd, data, numBytes);
    if (fd >= 0 && ::close(fd) != 0 && error == 0)
    {
        error = errno;
    }
    if (error != 0)
    {
        ::unlink(path.c_str());
        throw EnvironmentError("cannot write '" + path + "': " + std::strerror(error));
    }
}

void syncFolder(const std::string& folder)
{
    const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    const bool good = fd >= 0 && ::syncfs(fd) == 0;
    const int error = errno;
    if (fd >= 0)
    {
        ::close(fd);
    }
    if (!good)
    {
        throw EnvironmentError("cannot write to '" + folder + "': " + std::strerror(error));
    }
}
}  // namespace pointplane
