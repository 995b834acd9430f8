// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/byte_order_mark.h>
#include <pointplane/core/read_errors.h>
#include <pointplane/core/trimmed.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/params_ini.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>

namespace pointplane
{
namespace
{
/** File and line, or setting, of each ParameterRef::name(). */
using Places = std::map<std::string, std::string>;

[[nodiscard]] std::string withoutComment(const std::string& line)
{
    const std::string text = trimmed(line);
    if (text.empty() || text[0] == '#' || text[0] == ';')
    {
        return "";
    }
    return trimmed(text.substr(0, text.find("//")));
}

/** What is wrong in `action` is wrong at this place. */
template <class Action>
void at(const std::string& where, const Action& action)
{
    try
    {
        action();
    }
    catch (const InputError& e)
    {
        throw InputError(where + ": " + e.what());
    }
}

/** Of a line that begins with "[". */
[[nodiscard]] std::string sectionOf(const std::string& line, const ParameterTable& table)
{
    if (line.back() != ']')
    {
        throw InputError("expected [SECTION] alone, not " + line);
    }
    std::string section = trimmed(line.substr(1, line.size() - 2));
    requireSection(table, section);
    return section;
}

/** Sets the value of a line "key = value". */
void assignLine(
    const std::string& line,
    const std::string& section,
    const ParameterTable& table,
    const std::string& where,
    Places& places)
{
    const std::size_t equals = line.find('=');
    if (equals == std::string::npos)
    {
        throw InputError("expected 'key = value', found '" + line + "'");
    }
    const std::string key = trimmed(line.substr(0, equals));
    if (section.empty())
    {
        throw InputError("key '" + key + "' before any [Section]");
    }
    const ParameterRef& parameter = parameterOf(table, section, key);
    if (!places.emplace(parameter.name(), where).second)
    {
        throw InputError("key '" + key + "' appears twice in [" + section + "]");
    }
    parameter.set(trimmed(line.substr(equals + 1)));
}

/** parseIni(). \return of what it set */
Places parse(const std::string& text, const std::string& name, const ParameterTable& table)
{
    std::istringstream lines(text);
    skipByteOrderMark(lines);
    Places places;
    std::string line, section;
    for (int number = 1; std::getline(lines, line); ++number)
    {
        const std::string where = name + ":" + std::to_string(number);
        const std::string content = withoutComment(line);
        if (content.empty())
        {
            continue;
        }
        at(where,
           [&]
           {
               if (content.front() == '[')
               {
                   section = sectionOf(content, table);
               }
               else
               {
                   assignLine(content, section, table, where, places);
               }
           });
    }
    return places;
}

[[nodiscard]] std::string textOf(const std::string& path)
{
    std::error_code error;
    std::ifstream file(path);
    if (!file || std::filesystem::is_directory(path, error))
    {
        throw InputError(
            "cannot open configuration " + path + ": " +
            (error || !file ? std::strerror(errno) : "is a directory"));
    }
    constexpr std::size_t kLongest = 1U << 20U;
    const std::string text = readAll(file, kLongest + 1);
    if (file.bad())
    {
        throw InputError("cannot read configuration " + path + ": " + std::strerror(errno));
    }
    if (text.find('\0') != std::string::npos || text.compare(0, 2, "\x1f\x8b") == 0)
    {
        throw InputError(path + ": is not a text, as a configuration is");
    }
    if (text.size() > kLongest)
    {
        throw InputError(path + ": is longer than 1 MiB, as no configuration is");
    }
    return text;
}

/** Sets the value of "Section.key=value". \return which */
const ParameterRef& assignSetting(const std::string& setting, const ParameterTable& table)
{
    const std::size_t equals = setting.find('=');
    const std::size_t dot = setting.find('.');
    if (equals == std::string::npos || dot == std::string::npos || dot > equals)
    {
        throw InputError("expected Section.key=value");
    }
    const std::string section = trimmed(setting.substr(0, dot));
    const std::string key = trimmed(setting.substr(dot + 1, equals - dot - 1));
    const ParameterRef& parameter = parameterOf(table, section, key);
    parameter.set(trimmed(setting.substr(equals + 1)));
    return parameter;
}

/** applySettings(). \return of what it set */
Places apply(const std::vector<std::string>& settings, const ParameterTable& table)
{
    Places places;
    for (const std::string& setting : settings)
    {
        const std::string where = "setting '" + setting + "'";
        at(where,
           [&]
           {
               const std::string name = assignSetting(setting, table).name();
               if (!places.emplace(name, where).second)
               {
                   throw InputError(name + " is set twice");
               }
           });
    }
    return places;
}

/** Of the key that a problem begins with: "[Section] key = 3 is not ...". Empty: a default. */
[[nodiscard]] std::string placeOf(const std::string& problem, const Places& places)
{
    const std::size_t blank = problem.find(' ');
    const auto found = places.find(problem.substr(0, problem.find(' ', blank + 1)));
    return found == places.end() ? "" : found->second;
}
}  // namespace

void parseIni(const std::string& text, const std::string& name, const ParameterTable& table)
{
    (void)parse(text, name, table);
}

void applySettings(const std::vector<std::string>& settings, const ParameterTable& table)
{
    (void)apply(settings, table);
}

OdometryParams loadOdometryParams(const std::string& path, const std::vector<std::string>& settings)
{
    OdometryParams params;
    const ParameterTable table = parametersOf(params);
    Places ofFile = path.empty() ? Places() : parse(textOf(path), path, table);
    Places places = apply(settings, table);
    places.merge(ofFile);
    try
    {
        params.check();
    }
    catch (const std::invalid_argument& e)
    {
        const std::string place = placeOf(e.what(), places);
        const std::string file = path.empty() ? "configuration" : path;
        throw InputError((place.empty() ? file : place) + ": " + e.what());
    }
    return params;
}
}  // namespace pointplane
