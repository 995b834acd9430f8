// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/number_text.h>
#include <pointplane/mrpt_io/ParameterTable.h>
#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace pointplane
{
namespace
{
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

/** "did you mean 'gain'?", or all there are if none is like the word.
 * \param plural what they are \param open, close around a name */
[[nodiscard]] std::string suggestion(
    const std::string& word,
    const std::set<std::string>& candidates,
    const std::string& plural,
    const std::string& open,
    const std::string& close)
{
    std::string best, all;
    std::size_t bestDistance = word.size() / 2 + 1;  // half of the letters differ: another word
    for (const std::string& candidate : candidates)
    {
        all += (all.empty() ? "" : ", ") + candidate;
        if (const std::size_t d = editDistance(word, candidate); d < bestDistance)
        {
            bestDistance = d;
            best = candidate;
        }
    }
    return best.empty() ? plural + " are " + all : "did you mean " + open + best + close + "?";
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
}  // namespace

std::string ParameterRef::name() const { return "[" + section + "] " + key; }

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

void ParameterRef::set(const std::string& text) const
{
    const bool good = std::visit([&text](auto* target) { return assignTo(target, text); }, value);
    if (!good)
    {
        // All that a whole number can be refused for.
        const bool isTooLarge = std::holds_alternative<int*>(value) && isOfDigits(text);
        throw InputError(
            name() + " = '" + text + "' is " +
            (isTooLarge ? std::string("too large a number") : std::string("not ") + typeName()) +
            (text.find_first_of("#;") == std::string::npos
                 ? ""
                 : " (a comment after a value starts with //)"));
    }
}

void requireSection(const ParameterTable& table, const std::string& section)
{
    std::set<std::string> sections;
    for (const auto& p : table)
    {
        sections.insert(p.section);
    }
    if (sections.count(section) == 0)
    {
        throw InputError(
            "unknown section [" + section + "]; " +
            suggestion(section, sections, "sections", "[", "]"));
    }
}

const ParameterRef& parameterOf(
    const ParameterTable& table, const std::string& section, const std::string& key)
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
    requireSection(table, section);
    throw InputError(
        "unknown key '" + key + "' in [" + section + "]; " +
        (elsewhere.empty() ? suggestion(key, keys, "keys", "'", "'")
                           : "it belongs in [" + elsewhere + "]"));
}
}  // namespace pointplane
