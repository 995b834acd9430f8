// SPDX-License-Identifier: BSD-3-Clause
#include "result_output.h"

#include <pointplane/mrpt_io/OutputFile.h>
#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <charconv>
#include <cstdarg>
#include <cstdio>
#include <ostream>
#include <utility>
#include <vector>

#include "OutputGuard.h"
#include "TextOutput.h"
#include "command.h"
#include "standard_streams.h"

namespace pointplane
{
namespace
{
/** How long the folders and files are with which all of several names end; 0: a name is no more. */
[[nodiscard]] std::size_t commonEnding(const std::vector<std::string>& names)
{
    std::string ending = names.front();
    for (const std::string& name : names)
    {
        const auto differ =
            std::mismatch(ending.rbegin(), ending.rend(), name.rbegin(), name.rend()).first;
        ending.erase(ending.begin(), differ.base());
    }
    ending.erase(0, ending.find('/'));
    const auto isWhole = [&](const std::string& name) { return name.size() == ending.size(); };
    return std::any_of(names.begin(), names.end(), isWhole) ? 0 : ending.size();
}

/** Just so many characters: of a long name the end. */
[[nodiscard]] std::string fitted(const std::string& name, std::size_t width)
{
    const std::string dots = "...";
    std::vector<std::size_t> characters;  // where they begin, in UTF-8
    for (std::size_t k = 0; k < name.size(); ++k)
    {
        if ((static_cast<unsigned char>(name[k]) & 0xc0U) != 0x80)
        {
            characters.push_back(k);
        }
    }
    return characters.size() <= width
               ? name + std::string(width - characters.size(), ' ')
               : dots + name.substr(characters[characters.size() - (width - dots.size())]);
}

/** Whether this option stands for the standard output. */
[[nodiscard]] bool isShown(const std::string& path)
{
    return path == "-" || isStandardOutput(path);
}
}  // namespace

void OutputFiles::addTo(CLI::App& command, const std::string& single)
{
    command.add_option("--json", json, "Write the result as JSON ('-': to the standard output)")
        ->type_name("FILE")
        ->group("Output");
    command.add_option("--csv", csv, "Write the result as CSV ('-': to the standard output)")
        ->type_name("FILE")
        ->group("Output");
    if (!single.empty())
    {
        command
            .add_option(
                "--save", save, "Write a line per " + single + " as CSV ('-': standard output)")
            ->type_name("FILE")
            ->group("Output");
    }
}

void OutputFiles::guardedBy(OutputGuard& guard, bool lines) const
{
    const auto files = {json, csv, save};
    const auto isMissing = [](const std::string& path) { return path.empty(); };
    const auto numShown = std::count_if(files.begin(), files.end(), isShown) + (lines ? 1 : 0);
    if (numShown > 1)
    {
        throw InputError(
            "only one of --json, --csv, --save and --verbose can go to the standard output; give "
            "the others the name of a file");
    }
    if (numShown == 1 || std::all_of(files.begin(), files.end(), isMissing))
    {
        requireStandardOutput();
    }
    const auto add = [&](const char* option, const std::string& path)
    { guard.addText(option, path == "-" ? "" : path); };
    add("--json", json);
    add("--csv", csv);
    add("--save", save);
}

bool OutputFiles::replaceTable() const
{
    const auto files = {json, csv, save};
    return std::any_of(files.begin(), files.end(), isShown);
}

void OutputFiles::write(
    const nlohmann::ordered_json& asJson,
    const std::string& asCsv,
    const std::string& singles,
    std::ostream& out) const
{
    if (!json.empty())
    {
        // Names of files may be in any encoding, JSON is in UTF-8.
        using Handler = nlohmann::ordered_json::error_handler_t;
        writeText(asJson.dump(2, ' ', false, Handler::replace) + "\n", json, out);
    }
    if (!csv.empty())
    {
        writeText(asCsv, csv, out);
    }
    if (!save.empty())
    {
        writeText(singles, save, out);
    }
}

std::string format(const char* text, ...)
{
    va_list args, again;
    va_start(args, text);
    va_copy(again, args);
    std::string out(static_cast<std::size_t>(std::vsnprintf(nullptr, 0, text, args)), '\0');
    std::vsnprintf(out.data(), out.size() + 1, text, again);
    va_end(again);
    va_end(args);
    return out;
}

void printAsScripts(const char* name, const Statistics& error, const char* unit, std::ostream& out)
{
    const std::pair<const char*, double> values[] = {
        {"rmse", error.rmse},
        {"mean", error.mean},
        {"median", error.median},
        {"std", error.std},
        {"min", error.min},
        {"max", error.max}};
    for (const auto& [what, value] : values)
    {
        out << format("%s.%s %f %s\n", name, what, value, unit);
    }
}

std::string inOneLine(const std::string& text)
{
    std::string out;
    for (const char c : text)
    {
        const auto byte = static_cast<unsigned char>(c);
        out += c == '\n'                     ? "\\n"
               : c == '\t'                   ? "\\t"
               : byte < 0x20 || byte == 0x7f ? format("\\x%02x", byte)
                                             : std::string(1, c);
    }
    return out;
}

std::vector<std::string> shownNames(std::vector<std::string> names, std::size_t width)
{
    const auto isLong = [width](const std::string& name) { return name.size() > width; };
    if (names.size() > 1 && std::any_of(names.begin(), names.end(), isLong))
    {
        const std::size_t ending = commonEnding(names);
        for (std::string& name : names)
        {
            name.erase(name.size() - ending);
        }
    }
    for (std::string& name : names)
    {
        name = fitted(inOneLine(name), width);
    }
    return names;
}

std::string savedStamp(double stamp)
{
    char text[400];  // holds every double
    return {text, std::to_chars(text, text + sizeof text, stamp, std::chars_format::fixed).ptr};
}

std::string csvField(const std::string& text)
{
    if (text.find_first_of(",\"\n\r") == std::string::npos)
    {
        return text;
    }
    std::string out = "\"";
    for (const char c : text)
    {
        out += c == '"' ? "\"\"" : std::string(1, c);
    }
    return out + "\"";
}

void printTable(const ScoredResult& result, std::ostream& out)
{
    out << result.title << "\n"
        << result.protocol << "\n"
        << result.coverage << "\n"
        << "ground truth " << inOneLine(result.groundTruth) << "\n"
        << "estimate     " << inOneLine(result.estimate) << "\n\n"
        << format(
               "%-17s%12s%12s%12s%12s%12s%12s\n",
               "",
               "rmse",
               "mean",
               "median",
               "std",
               "min",
               "max");
    for (const StatisticsRow& row : result.rows)
    {
        const Statistics& s = row.statistics;
        out << format(
            "%-17s %11.6f %11.6f %11.6f %11.6f %11.6f %11.6f\n",
            (row.name + " [" + row.unit + "]").c_str(),
            s.rmse,
            s.mean,
            s.median,
            s.std,
            s.min,
            s.max);
    }
}

nlohmann::ordered_json toJson(const ScoredResult& result)
{
    nlohmann::ordered_json json;
    json["title"] = result.title;
    json["protocol"] = result.protocol + ", " + result.coverage;
    json["groundTruth"] = result.groundTruth;
    json["estimate"] = result.estimate;
    for (const StatisticsRow& row : result.rows)
    {
        const Statistics& s = row.statistics;
        json[row.name] = {
            {"unit", row.unit},
            {"count", s.count},
            {"rmse", s.rmse},
            {"mean", s.mean},
            {"median", s.median},
            {"std", s.std},
            {"min", s.min},
            {"max", s.max}};
    }
    json.update(result.details);
    return json;
}

nlohmann::ordered_json toJson(const Coverage& coverage)
{
    nlohmann::ordered_json json{
        {"share", coverage.share},
        {"of", coverage.ofRecording ? "recording" : "groundTruth"},
        {"ofGroundTruth", coverage.ofTruth}};
    json["frames"] = coverage.ofRecording
                         ? nlohmann::ordered_json{
                               {"tracked", coverage.tracked},
                               {"predicted", coverage.predicted},
                               {"lost", coverage.lost}}
                         : nlohmann::ordered_json();
    return json;
}

std::string toCsv(const ScoredResult& result)
{
    std::string out =
        "estimate,ground_truth,protocol,quantity,unit,count,rmse,mean,median,std,min,max\n";
    for (const StatisticsRow& row : result.rows)
    {
        const Statistics& s = row.statistics;
        out += csvField(result.estimate) + "," + csvField(result.groundTruth) + "," +
               csvField(result.protocol + ", " + result.coverage) + "," + row.name + "," +
               row.unit +
               format(
                   ",%zu,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n",
                   s.count,
                   s.rmse,
                   s.mean,
                   s.median,
                   s.std,
                   s.min,
                   s.max);
    }
    return out;
}

void writeText(const std::string& text, const std::string& path, std::ostream& out)
{
    if (path == "-")
    {
        out << text;
        return;
    }
    TextOutput file(path);
    file.write(text);
    file.close();
}

void writeResult(
    const ScoredResult& result, const OutputFiles& files, std::ostream& out, bool table)
{
    if (table && !files.replaceTable())
    {
        printTable(result, out);
    }
    files.write(toJson(result), toCsv(result), result.singles, out);
}

void checkThreshold(
    const std::string& name, const StatisticsRow& row, double threshold, CommandContext& context)
{
    if (threshold >= 0 && !(row.statistics.rmse <= threshold))
    {
        context.err << context.program
                    << format(
                           ": %s %.6f %s exceeds the threshold %g %s\n",
                           name.c_str(),
                           row.statistics.rmse,
                           row.unit.c_str(),
                           threshold,
                           row.unit.c_str());
        context.exitCode = kExitIncomplete;
    }
    else if (row.unit == "m" && threshold > 1 && threshold > 100 * row.statistics.rmse)
    {
        context.err << context.program
                    << format(
                           ": warning: the threshold is %g m, the %s %.6f m: is it in "
                           "millimetres?\n",
                           threshold,
                           name.c_str(),
                           row.statistics.rmse);
    }
}
}  // namespace pointplane
