// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/params_ini.h>

#include <cstddef>
#include <sstream>

namespace pointplane
{
namespace
{
constexpr const char* kExpert = "the insides of each stage. Few recordings need another value.";
}  // namespace

std::string iniText(const ParameterTable& table, const std::string& firstExpert)
{
    std::ostringstream out;
    const bool isWhole = !firstExpert.empty();
    out << (isWhole ? "# Complete configuration of pointplane-odometry, written by --dump-config.\n"
                    : "")
        << "# A comment after a value starts with //.\n";
    std::string section;
    for (const auto& p : table)
    {
        if (p.section != section)
        {
            section = p.section;
            out << (section == firstExpert ? "\n# For experts: " + std::string(kExpert) + "\n" : "")
                << "\n[" << section << "]\n";
        }
        const std::string assignment = p.key + " = " + p.text();
        constexpr std::size_t kColumn = 36;
        out << assignment
            << std::string(assignment.size() < kColumn ? kColumn - assignment.size() : 0, ' ')
            << " // [" << p.unit << "] " << p.help << "\n";
    }
    return out.str();
}
}  // namespace pointplane
