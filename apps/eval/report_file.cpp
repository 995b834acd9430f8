// SPDX-License-Identifier: BSD-3-Clause
#include "report_file.h"

#include <pointplane/core/number_text.h>
#include <pointplane/evaluation/svg_chart.h>
#include <pointplane/mrpt_io/OutputFolder.h>

#include <cctype>
#include <cstdlib>
#include <ctime>
#include <ostream>

#include "OutputGuard.h"
#include "command.h"
#include "result_output.h"

namespace pointplane
{
namespace
{
/** "path-from-above" of "Path from above". */
std::string fileNameOf(const std::string& title)
{
    std::string out;
    for (const char c : title)
    {
        const auto letter = static_cast<unsigned char>(c);
        if (std::isalnum(letter) != 0)
        {
            out += static_cast<char>(std::tolower(letter));
        }
        else if (!out.empty() && out.back() != '-')
        {
            out += '-';
        }
    }
    return out.substr(0, out.find_last_not_of('-') + 1);
}

/** Time of day, UTC; SOURCE_DATE_EPOCH stands in for it where reports have to be repeatable. */
std::string timeText()
{
    const char* fixed = std::getenv("SOURCE_DATE_EPOCH");
    const std::time_t now =
        fixed != nullptr ? parseNumber<std::time_t>(fixed).value_or(0) : std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S UTC", &utc);
    return text;
}
}  // namespace

void guardReport(OutputGuard& guard, const std::string& directory)
{
    guard.addOutputFolder("--report", directory, ".html");
    guard.addOutputFolder("--report", directory, ".svg");
}

void writeReportFile(HtmlReport report, const std::string& directory, CommandContext& context)
{
    report.addParagraph(
        "pointplane-eval " POINTPLANE_VERSION ", " + timeText() + ": " + context.commandLine);
    const OutputFolder folder(directory);
    const std::string path = folder.fileAt("index.html");
    writeText(report.html(), path, context.out);
    for (const Chart& chart : report.charts())
    {
        writeText(svgFileOf(chart), folder.fileAt(fileNameOf(chart.title) + ".svg"), context.out);
    }
    context.err << "report: " << path << "\n";
}
}  // namespace pointplane
