// SPDX-License-Identifier: BSD-3-Clause
#include "accuracy_tables.h"

#include <cmath>
#include <cstdio>
#include <regex>
#include <sstream>

#include "MarkdownGrid.h"

namespace pointplane
{
namespace
{
[[nodiscard]] std::string number(double value, int digits)
{
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
}

[[nodiscard]] double mm(double metres) { return 1e3 * metres; }
[[nodiscard]] double degrees(double radians) { return radians * 180 / M_PI; }

/** Whether parameters of config.ini were chosen on a recording or on a part of it
 * (docs/experiments.md, "What took part in which choice"). */
[[nodiscard]] std::string chosenOn(const std::string& sequence)
{
    static const std::regex kChosen(
        ".*(fr|freiburg)1_(xyz|rpy)(_part)?|.*(fr|freiburg)3_structure_notexture_far(_part)?|"
        "icl_living_room_kt0.*|iphone.*|azure.*|kinect1_fixed.*|simulated desk");
    return std::regex_match(sequence, kChosen)    ? "yes"
           : sequence.rfind("simulated ", 0) == 0 ? "other seeds"
                                                  : "no";
}

/** The peer with the smallest value, or nullptr without any. */
template <class Value>
[[nodiscard]] const MethodScore* bestPeer(const SequenceScores& scores, Value value)
{
    const MethodScore* best = nullptr;
    for (const MethodScore& m : scores.methods)
    {
        if (m.isPeer && m.failure.empty() && (best == nullptr || value(m) < value(*best)))
        {
            best = &m;
        }
    }
    return best;
}

[[nodiscard]] const MethodScore* firstOfOurs(const SequenceScores& scores)
{
    for (const MethodScore& m : scores.methods)
    {
        if (!m.isPeer)
        {
            return &m;
        }
    }
    return nullptr;
}

[[nodiscard]] std::string errors(const MethodScore& m)
{
    return m.failure.empty()
               ? number(mm(m.rpeTranslation), 1) + " / " + number(degrees(m.rpeRotation), 2)
               : "failed";
}

/** The least translation and rotation, and whose they are. */
[[nodiscard]] std::string leastErrors(const MethodScore& t, const MethodScore& r)
{
    return &t == &r ? errors(t) + " (" + t.method + ")"
                    : number(mm(t.rpeTranslation), 1) + " (" + t.method + ") / " +
                          number(degrees(r.rpeRotation), 2) + " (" + r.method + ")";
}

[[nodiscard]] std::string neesText(const MethodScore& m)
{
    std::string out;
    for (const auto& value : m.nees)
    {
        out += (out.empty() ? "" : " / ") + (value ? number(*value, 2) : "-");
    }
    return m.nees.front() ? out : "-";
}
}  // namespace

std::string markdownTable(const SequenceScores& scores)
{
    std::ostringstream out;
    out << "### " << scores.sequence << " ("
        << (scores.methods.empty() ? 0 : scores.methods.front().numFrames) << " frames)\n\n"
        << "| method | RPE mm/s | RPE deg/s | ATE mm | lost / predicted | ms median | ms p99 | "
           "NEES/dof 1 frame | 10 frames | 1 s |\n"
        << "|---|---|---|---|---|---|---|---|---|---|\n";
    for (const MethodScore& m : scores.methods)
    {
        if (!m.failure.empty())
        {
            out << "| " << m.method << " | failed: " << m.failure << " | | | | | | | | |\n";
            continue;
        }
        out << "| " << m.method << " | " << number(mm(m.rpeTranslation), 1) << " | "
            << number(degrees(m.rpeRotation), 2) << " | " << number(mm(m.ate), 1) << " | "
            << m.numLost << " / " << m.numPredicted << " | " << number(m.msMedian, 1) << " | "
            << number(m.msP99, 1);
        for (const auto& nees : m.nees)
        {
            out << " | " << (nees ? number(*nees, 2) : "-");
        }
        out << " |\n";
    }
    return out.str();
}

std::string markdownOverview(const std::vector<SequenceScores>& all)
{
    MarkdownGrid grid;
    for (const SequenceScores& scores : all)
    {
        for (const MethodScore& m : scores.methods)
        {
            grid.add(m.method, scores.sequence, errors(m));
        }
    }
    return "\nAll methods, RPE over a second, mm / deg:\n\n" + grid.markdown("method");
}

std::string markdownSummary(const std::vector<SequenceScores>& all)
{
    const auto translation = [](const MethodScore& m) { return m.rpeTranslation; };
    const auto rotation = [](const MethodScore& m) { return m.rpeRotation; };
    std::ostringstream rows;
    std::string name = "ours";
    for (const SequenceScores& scores : all)
    {
        const MethodScore* own = firstOfOurs(scores);
        const MethodScore* t = bestPeer(scores, translation);
        const MethodScore* r = bestPeer(scores, rotation);
        if (own == nullptr || t == nullptr || r == nullptr)
        {
            continue;
        }
        name = own->method;
        const bool isAhead = own->failure.empty() && own->rpeTranslation < t->rpeTranslation &&
                             own->rpeRotation < r->rpeRotation;
        rows << "| " << scores.sequence << " | " << chosenOn(scores.sequence) << " | "
             << (isAhead ? errors(*own) : "**" + errors(*own) + "**") << " | "
             << leastErrors(*t, *r) << " | " << neesText(*own) << " |\n";
    }
    return "| sequence | chosen on it | " + name +
           " [mm / deg] | least of a peer [mm / deg] | NEES over 1 frame / 10 frames / 1 s |\n"
           "|---|---|---|---|---|\n" +
           rows.str();
}

void requireNoFailures(const std::vector<SequenceScores>& all)
{
    for (const SequenceScores& scores : all)
    {
        for (const MethodScore& m : scores.methods)
        {
            if (!m.isPeer && !m.failure.empty())
            {
                throw IncompleteError(
                    m.method + " failed on " + scores.sequence + ": " + m.failure);
            }
        }
    }
}

nlohmann::ordered_json toJson(const std::vector<SequenceScores>& all)
{
    auto out = nlohmann::ordered_json::array();
    for (const SequenceScores& scores : all)
    {
        for (const MethodScore& m : scores.methods)
        {
            nlohmann::ordered_json row{
                {"sequence", scores.sequence},
                {"method", m.method},
                {"peer", m.isPeer},
                {"frames", m.numFrames}};
            if (!m.failure.empty())
            {
                row["failure"] = m.failure;
                out.push_back(row);
                continue;
            }
            row["lost"] = m.numLost;
            row["predicted"] = m.numPredicted;
            row["rpe_translation_m"] = m.rpeTranslation;
            row["rpe_rotation_deg"] = degrees(m.rpeRotation);
            row["ate_m"] = m.ate;
            row["ms_median"] = m.msMedian;
            row["ms_p99"] = m.msP99;
            const char* const names[] = {"nees_1f", "nees_10f", "nees_1s"};
            for (std::size_t i = 0; i < m.nees.size(); ++i)
            {
                row[names[i]] = m.nees[i] ? nlohmann::ordered_json(*m.nees[i]) : nullptr;
            }
            out.push_back(row);
        }
    }
    return out;
}
}  // namespace pointplane
