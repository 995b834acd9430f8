// SPDX-License-Identifier: BSD-3-Clause
#include "text_file.h"

#include <pointplane/mrpt_io/errors.h>

#include <fstream>

namespace pointplane
{
void writeTextFile(const std::string& path, const std::string& text)
{
    std::ofstream file(path);
    file << text;
    file.close();
    if (!file)
    {
        throw EnvironmentError(path + ": cannot be written");
    }
}
}  // namespace pointplane
