// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <sched.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

namespace pointplane::test
{
/** Runs f in a process of its own, in which a folder is a disk of so many kilobytes (a tmpfs that
 * nobody else sees). \return what f returns, 0 to 99; nothing when this user may not mount */
template <class F>
[[nodiscard]] std::optional<int> onSmallDisk(const std::string& folder, int kilobytes, const F& f)
{
    constexpr int kMayNotMount = 100;
    std::filesystem::create_directories(folder);
    const pid_t child = ::fork();
    if (child == 0)
    {
        const std::string size = "size=" + std::to_string(kilobytes) + "k";
        const bool alone =
            ::unshare(CLONE_NEWNS) == 0 || ::unshare(CLONE_NEWUSER | CLONE_NEWNS) == 0;
        if (!alone || ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
            ::mount("none", folder.c_str(), "tmpfs", 0, size.c_str()) != 0)
        {
            ::_exit(kMayNotMount);
        }
        ::_exit(f());
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return code == kMayNotMount ? std::nullopt : std::optional<int>(code);
}
}  // namespace pointplane::test
