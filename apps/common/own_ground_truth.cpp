// SPDX-License-Identifier: BSD-3-Clause
#include "own_ground_truth.h"

#include <filesystem>
#include <fstream>

namespace pointplane
{
bool isReplaceable(const std::string& path, const std::string& text)
{
    namespace fs = std::filesystem;
    std::error_code error;
    if (!fs::is_regular_file(path, error))
    {
        return true;
    }
    std::ifstream file(path, std::ios::binary);
    std::string start(text.size() + 1, '\0');
    file.read(start.data(), static_cast<std::streamsize>(start.size()));
    start.resize(static_cast<std::size_t>(file.gcount()));
    const bool isOwn = !fs::is_symlink(path, error) &&
                       (start.rfind(kRenderedTruth, 0) == 0 || start.rfind(kCopiedTruth, 0) == 0);
    return file.is_open() && (isOwn || text.find(start) != std::string::npos);
}
}  // namespace pointplane
