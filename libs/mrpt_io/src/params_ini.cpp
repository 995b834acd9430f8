// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/byte_order_mark.h>
#include <pointplane/core/number_text.h>
#include <pointplane/core/trimmed.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/params_ini.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <numeric>
#include <set>
#include <sstream>

namespace pointplane
{
namespace
{
constexpr const char* kExpert = "the insides of each stage. Few recordings need another value.";

/** Levenshtein distance: insertions, deletions and exchanges from a to b. */
[[nodiscard]] std::size_t editDistance(const std::string& a, const std::string& b)
{
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), 0U);
    for (std::size_t i = 1; i <= a.size(); ++i)
    {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j)
        {
            const std::size_t exchange = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, exchange});
        }
    }
    return row.back();
}

[[nodiscard]] std::string closest(const std::string& word, const std::set<std::string>& candidates)
{
    std::string best;
    std::size_t bestDistance = std::string::npos;
    for (const std::string& candidate : candidates)
    {
        if (const std::size_t d = editDistance(word, candidate); d < bestDistance)
        {
            bestDistance = d;
            best = candidate;
        }
    }
    return best;
}

[[nodiscard]] std::set<std::string> sectionsOf(const ParameterTable& table)
{
    std::set<std::string> out;
    for (const auto& p : table)
    {
        out.insert(p.section);
    }
    return out;
}

[[noreturn]] void failUnknownSection(
    const std::string& where, const std::string& section, const ParameterTable& table)
{
    throw InputError(
        where + ": unknown section [" + section + "]; did you mean [" +
        closest(section, sectionsOf(table)) + "]?");
}

[[nodiscard]] const ParameterRef& find(
    const std::string& where,
    const std::string& section,
    const std::string& key,
    const ParameterTable& table)
{
    std::set<std::string> keys;
    std::string elsewhere;
    for (const auto& p : table)
    {
        if (p.section == section)
        {
            if (p.key == key)
            {
                return p;
            }
            keys.insert(p.key);
        }
        else if (p.key == key)
        {
            elsewhere = p.section;
        }
    }
    if (keys.empty())
    {
        failUnknownSection(where, section, table);
    }
    throw InputError(
        where + ": unknown key '" + key + "' in [" + section + "]; " +
        (elsewhere.empty() ? "did you mean '" + closest(key, keys) + "'?"
                           : "it belongs in [" + elsewhere + "]"));
}

[[nodiscard]] bool assignTo(bool* target, const std::string& text)
{
    const bool yes = text == "true" || text == "1" || text == "yes";
    *target = yes;
    return yes || text == "false" || text == "0" || text == "no";
}
[[nodiscard]] bool assignTo(std::string* target, const std::string& text)
{
    *target = text;
    return !text.empty();
}
template <class Number>
[[nodiscard]] bool assignTo(Number* target, const std::string& text)
{
    const auto number = parseNumber<Number>(text);
    if (!number || !std::isfinite(static_cast<double>(*number)))
    {
        return false;
    }
    *target = *number;
    return true;
}

/** Whether it is digits and perhaps a sign. */
[[nodiscard]] bool isOfDigits(const std::string& text)
{
    const std::size_t digits = text.find_first_of("+-") == 0 ? 1 : 0;
    return text.size() > digits &&
           text.find_first_not_of("0123456789", digits) == std::string::npos;
}

void assign(const std::string& where, const ParameterRef& parameter, const std::string& text)
{
    const bool good =
        std::visit([&text](auto* target) { return assignTo(target, text); }, parameter.value);
    if (!good)
    {
        // All that a whole number can be refused for.
        const bool isTooLarge = std::holds_alternative<int*>(parameter.value) && isOfDigits(text);
        throw InputError(
            where + ": [" + parameter.section + "] " + parameter.key + " = '" + text + "' is " +
            (isTooLarge ? std::string("too large a number")
                        : std::string("not ") + parameter.typeName()) +
            (text.find_first_of("#;") == std::string::npos
                 ? ""
                 : " (a comment after a value starts with //)"));
    }
}

/** File and line, or setting, of "[Section] key". */
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

/** parseIni(), which also tells the places of what it read. */
void parse(
    const std::string& text, const std::string& name, const ParameterTable& table, Places& places)
{
    std::istringstream lines(text);
    skipByteOrderMark(lines);
    std::string line, section;
    std::set<std::string> seen;
    for (int number = 1; std::getline(lines, line); ++number)
    {
        const std::string where = name + ":" + std::to_string(number);
        const std::string content = withoutComment(line);
        if (content.empty())
        {
            continue;
        }
        if (content.front() == '[')
        {
            if (content.back() != ']')
            {
                throw InputError(where + ": expected [SECTION] alone, not " + content);
            }
            section = trimmed(content.substr(1, content.size() - 2));
            if (sectionsOf(table).count(section) == 0)
            {
                failUnknownSection(where, section, table);
            }
            continue;
        }
        const std::size_t equals = content.find('=');
        if (equals == std::string::npos)
        {
            throw InputError(where + ": expected 'key = value', found '" + content + "'");
        }
        const std::string key = trimmed(content.substr(0, equals));
        if (section.empty())
        {
            throw InputError(where + ": key '" + key + "' before any [Section]");
        }
        const ParameterRef& parameter = find(where, section, key, table);
        if (!seen.insert(section + "." + key).second)
        {
            throw InputError(where + ": key '" + key + "' appears twice in [" + section + "]");
        }
        assign(where, parameter, trimmed(content.substr(equals + 1)));
        places["[" + section + "] " + key] = where;
    }
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
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/** \return "[Section] key" */
std::string apply(const std::string& setting, const ParameterTable& table)
{
    const std::string where = "setting '" + setting + "'";
    const std::size_t equals = setting.find('=');
    const std::size_t dot = setting.find('.');
    if (equals == std::string::npos || dot == std::string::npos || dot > equals)
    {
        throw InputError(where + ": expected Section.key=value");
    }
    const std::string section = trimmed(setting.substr(0, dot));
    const std::string key = trimmed(setting.substr(dot + 1, equals - dot - 1));
    assign(where, find(where, section, key, table), trimmed(setting.substr(equals + 1)));
    return "[" + section + "] " + key;
}

/** applySettings(), likewise. */
void apply(const std::vector<std::string>& settings, const ParameterTable& table, Places& places)
{
    std::set<std::string> seen;
    for (const std::string& setting : settings)
    {
        const std::string where = "setting '" + setting + "'", key = apply(setting, table);
        if (!seen.insert(key).second)
        {
            throw InputError(where + ": " + key + " is set twice");
        }
        places[key] = where;
    }
}

/** Of the key that a problem begins with: "[Section] key = 3 is not ...". Empty: a default. */
[[nodiscard]] std::string placeOf(const std::string& problem, const Places& places)
{
    const std::size_t blank = problem.find(' ');
    const auto found = places.find(problem.substr(0, problem.find(' ', blank + 1)));
    return found == places.end() ? "" : found->second;
}
}  // namespace

std::string ParameterRef::text() const
{
    struct Writer
    {
        std::string operator()(const bool* v) const { return *v ? "true" : "false"; }
        std::string operator()(const int* v) const { return std::to_string(*v); }
        std::string operator()(const double* v) const { return numberText(*v); }
        std::string operator()(const std::string* v) const { return *v; }
    };
    return std::visit(Writer(), value);
}

const char* ParameterRef::typeName() const
{
    static constexpr const char* kNames[] = {
        "true or false", "a whole number", "a number", "a word"};
    return kNames[value.index()];
}

void parseIni(const std::string& text, const std::string& name, const ParameterTable& table)
{
    Places places;
    parse(text, name, table, places);
}

void loadIni(const std::string& path, const ParameterTable& table)
{
    parseIni(textOf(path), path, table);
}

void applySettings(const std::vector<std::string>& settings, const ParameterTable& table)
{
    Places places;
    apply(settings, table, places);
}

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

std::string markdownText(const ParameterTable& table, const std::string& firstExpert)
{
    std::ostringstream out;
    std::string section;
    for (const auto& p : table)
    {
        if (p.section != section)
        {
            out << (section.empty() ? "" : "\n")
                << (p.section == firstExpert ? "**For experts:** " + std::string(kExpert) + "\n\n"
                                             : "")
                << "### [" << p.section
                << "]\n\n| key | default | unit | meaning |\n|---|---|---|---|\n";
            section = p.section;
        }
        out << "| `" << p.key << "` | " << p.text() << " | " << p.unit << " | " << p.help << " |\n";
    }
    return out.str();
}

OdometryParams loadOdometryParams(const std::string& path, const std::vector<std::string>& settings)
{
    OdometryParams params;
    const ParameterTable table = parametersOf(params);
    Places places;
    if (!path.empty())
    {
        parse(textOf(path), path, table, places);
    }
    apply(settings, table, places);
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
