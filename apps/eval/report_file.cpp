// SPDX-License-Identifier: BSD-3-Clause
#include "report_file.h"

#include <pointplane/core/number_text.h>
#include <pointplane/evaluation/svg_chart.h>
#include <pointplane/mrpt_io/OutputFolder.h>

#include <cctype>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <ostream>
#include <set>
#include <string>
#include <system_error>

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

/** What is to be said of charts in a folder that are not of this report, as those of a run with
 * other options. \param written names of this report's */
std::string otherChartsText(const std::string& directory, const std::set<std::string>& written)
{
    std::set<std::string> others;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(directory, error))
    {
        const std::string name = entry.path().filename();
        if (entry.path().extension() == ".svg" && written.count(name) == 0)
        {
            others.insert(name);
        }
    }
    return others.empty() ? ""
                          : "; SVG files beside it that are not of this report: " +
                                std::to_string(others.size()) + ", e.g. " + *others.begin();
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
    std::set<std::string> written;
    for (const Chart& chart : report.charts())
    {
        const std::string name = fileNameOf(chart.title) + ".svg";
        writeText(svgFileOf(chart), folder.fileAt(name), context.out);
        written.insert(name);
    }
    context.err << "report: " << inOneLine(path + otherChartsText(directory, written)) << "\n";
}
}  // namespace pointplane
