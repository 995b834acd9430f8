// SPDX-License-Identifier: BSD-3-Clause
#include "envelope_tables.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <sstream>

#include "envelope_cells.h"

namespace pointplane
{
namespace
{
[[nodiscard]] std::string header(const Cell& cell)
{
    const bool hasTruth = cell.own->truth != Truth::None;
    std::string out = "| condition | frames | tracked % |";
    out += hasTruth ? " RPE | worst step |" : " largest step |";
    out += cell.own->truth == Truth::Exact ? " beyond 5σ | NEES median / 99 % |" : " largest σ |";
    for (const EnvelopeScore* s : cell.others)
    {
        out += " " + s->method + (hasTruth ? " RPE |" : " largest step |");
    }
    if (!cell.peers.empty() && hasTruth)
    {
        out += " best peer's RPE |";
    }
    const auto columns = std::count(out.begin(), out.end(), '|') - 1;
    out += "\n|";
    for (long i = 0; i < columns; ++i)
    {
        out += "---|";
    }
    return out + "\n";
}

[[nodiscard]] std::string row(const Cell& cell)
{
    const EnvelopeScore& s = *cell.own;
    const bool hasTruth = s.truth != Truth::None;
    std::string out =
        "| " + s.condition + " | " + text("%zu", s.numSteps) + " | " + shareText(s) + " |";
    out += hasTruth ? " " + rpeText(s) + " |" : "";
    out += " " + worstStepText(s) + " |";
    if (s.truth == Truth::Exact)
    {
        out += s.beyond.empty() ? " 0 |" : text(" **%zu** |", s.beyond.size());
        out += s.neesMedian ? text(" %.2f / %.1f |", *s.neesMedian, *s.nees99) : " - |";
    }
    else
    {
        out += text(" %.0f mm |", mm(s.largestSigma));
    }
    for (const EnvelopeScore* other : cell.others)
    {
        out += " " + (hasTruth ? rpeText(*other) : worstStepText(*other)) + " |";
    }
    if (!cell.peers.empty() && hasTruth)
    {
        const EnvelopeScore* t = bestPeer(cell, &EnvelopeScore::rpeTranslation);
        const EnvelopeScore* r = bestPeer(cell, &EnvelopeScore::rpeRotation);
        out += t == nullptr ? " - |"
               : t == r     ? " " + rpeText(*t) + " " + t->method + " |"
                            : " " + errorText(t->rpeTranslation, r->rpeRotation) + " " + t->method +
                              " / " + r->method + " |";
    }
    return out + "\n";
}

/** Sums over cells. */
struct Sum
{
    std::string name;
    std::size_t steps{0}, tracked{0}, beyond{0}, failures{0};
    double worstTranslation{0}, worstRotation{0};

    void add(const EnvelopeScore& s)
    {
        steps += s.numSteps;
        tracked += s.numTracked;
        beyond += s.beyond.size();
        failures += s.failure.empty() ? 0 : 1;
        worstTranslation = std::max(worstTranslation, s.worstTranslation);
        worstRotation = std::max(worstRotation, s.worstRotation);
    }
};

/** \param key what the sums are told apart by, in order of appearance */
[[nodiscard]] std::string sumTable(
    const std::vector<EnvelopeScore>& scores,
    const std::string& title,
    const std::function<std::string(const EnvelopeScore&)>& key)
{
    std::vector<Sum> sums;
    for (const EnvelopeScore& s : scores)
    {
        const std::string name = s.truth == Truth::Exact ? key(s) : "";
        if (name.empty())
        {
            continue;
        }
        auto it = std::find_if(
            sums.begin(), sums.end(), [&name](const Sum& sum) { return sum.name == name; });
        if (it == sums.end())
        {
            it = sums.insert(sums.end(), Sum());
            it->name = name;
        }
        it->add(s);
    }
    std::ostringstream out;
    out << "| " << title
        << " | steps | tracked % | beyond 5σ | largest error, mm / deg |\n|---|---|---|---|---|\n";
    for (const Sum& s : sums)
    {
        out << "| " << s.name << " | " << s.steps
            << (s.failures > 0 ? text(", gave up in %zu cells", s.failures) : "") << " | "
            << (100 * s.tracked) / std::max<std::size_t>(s.steps, 1) << " | " << s.beyond << " | "
            << errorText(s.worstTranslation, s.worstRotation) << " |\n";
    }
    return out.str();
}

/** How often we are behind a peer, and a line per sequence with the conditions. */
[[nodiscard]] std::string behindPeers(const std::vector<EnvelopeScore>& scores)
{
    std::size_t compared = 0, behind = 0;
    std::string lines, sequence;
    for (const Cell& cell : cellsOf(scores))
    {
        const EnvelopeScore* t = bestPeer(cell, &EnvelopeScore::rpeTranslation);
        const EnvelopeScore* r = bestPeer(cell, &EnvelopeScore::rpeRotation);
        const bool gaveUp = !cell.own->failure.empty();
        if (t == nullptr || r == nullptr || (cell.own->numPairs == 0 && !gaveUp))
        {
            continue;
        }
        ++compared;
        if (gaveUp || cell.own->rpeTranslation > t->rpeTranslation ||
            cell.own->rpeRotation > r->rpeRotation)
        {
            ++behind;
            lines += cell.own->sequence == sequence ? ", " : "\n- " + cell.own->sequence + ": ";
            lines += cell.own->condition + (gaveUp ? " (gave up)" : "");
            sequence = cell.own->sequence;
        }
    }
    if (compared == 0)
    {
        return "";
    }
    return text("\nBehind the best peer in %zu of %zu cells", behind, compared) +
           (behind == 0 ? ".\n" : ":\n" + lines + "\n");
}
}  // namespace

std::string envelopeSummary(const std::vector<EnvelopeScore>& scores)
{
    if (scores.empty())
    {
        return "";
    }
    const std::string own = scores.front().method;
    const auto method = [](const EnvelopeScore& s) { return s.isPeer ? "" : s.method; };
    const auto condition = [&own](const EnvelopeScore& s)
    { return s.method == own ? s.condition : ""; };
    return sumTable(scores, "all with exact truth", method) +
           (hasOneCondition(scores) ? ""
                                    : "\n" + sumTable(scores, own + ", by condition", condition)) +
           behindPeers(scores);
}

std::string envelopeTables(const std::vector<EnvelopeScore>& scores)
{
    std::string out, sequence;
    for (const Cell& cell : cellsOf(scores))
    {
        if (cell.own->sequence != sequence)
        {
            sequence = cell.own->sequence;
            out += (out.empty() ? "### " : "\n### ") + sequence + "\n\n" + header(cell);
        }
        out += row(cell);
    }
    return out;
}

void requireNoFailures(const std::vector<EnvelopeScore>& scores)
{
    for (const EnvelopeScore& s : scores)
    {
        if (!s.isPeer && !s.failure.empty())
        {
            throw IncompleteError(
                s.method + " gave up in " + s.sequence + ", " + s.condition + ": " + s.failure);
        }
    }
}

std::string envelopeCsv(const std::vector<EnvelopeScore>& scores)
{
    std::string out =
        "sequence,condition,method,peer,steps,tracked,beyond_5_sigma,large,rpe_mm,rpe_deg,"
        "worst_mm,worst_deg,largest_sigma_mm,nees_median,nees_99,failure\n";
    for (const EnvelopeScore& s : scores)
    {
        out += s.sequence + "," + s.condition + "," + s.method + "," + (s.isPeer ? "1" : "0") +
               text(",%zu,%zu,%zu,%zu,", s.numSteps, s.numTracked, s.beyond.size(), s.large.size());
        out +=
            s.numPairs > 0 ? text("%.3f,%.4f", mm(s.rpeTranslation), degrees(s.rpeRotation)) : ",";
        out += text(
            ",%.3f,%.4f,%.3f,",
            mm(s.worstTranslation),
            degrees(s.worstRotation),
            mm(s.largestSigma));
        out += s.neesMedian ? text("%.4f,%.4f", *s.neesMedian, *s.nees99) : ",";
        out += "," + s.failure + "\n";
    }
    return out;
}

std::vector<EnvelopeScore> scoresFromCsv(const std::string& path)
{
    constexpr std::size_t kColumns = 16;
    std::ifstream file(path);
    std::string line;
    if (!std::getline(file, line))
    {
        throw std::runtime_error(path + ": cannot be read or is empty");
    }
    std::vector<EnvelopeScore> out;
    for (int number = 2; std::getline(file, line); ++number)
    {
        std::vector<std::string> v;
        std::istringstream fields(line);
        for (std::string field; std::getline(fields, field, ',');)
        {
            v.push_back(field);
        }
        // The last one may be empty, or hold commas, of which the first part will do.
        v.resize(kColumns - 1 <= v.size() ? kColumns : 0);
        if (v.empty())
        {
            throw std::runtime_error(path + ":" + std::to_string(number) + ": not 16 columns");
        }
        EnvelopeScore s;
        s.sequence = v[0];
        s.condition = v[1];
        s.method = v[2];
        s.isPeer = v[3] == "1";
        s.numSteps = std::stoul(v[4]);
        s.numTracked = std::stoul(v[5]);
        s.beyond.resize(std::stoul(v[6]));
        s.large.resize(std::stoul(v[7]));
        if (!v[8].empty())
        {
            s.numPairs = 1;
            s.rpeTranslation = std::stod(v[8]) / 1e3;
            s.rpeRotation = std::stod(v[9]) * M_PI / 180;
        }
        s.worstTranslation = std::stod(v[10]) / 1e3;
        s.worstRotation = std::stod(v[11]) * M_PI / 180;
        s.largestSigma = std::stod(v[12]) / 1e3;
        s.failure = v[15];
        out.push_back(std::move(s));
    }
    return out;
}

std::vector<EnvelopeScore> withMethodsOf(
    const std::vector<EnvelopeScore>& scores, const std::vector<EnvelopeScore>& others)
{
    const auto isSameCell = [](const EnvelopeScore& a, const EnvelopeScore& b)
    { return a.sequence == b.sequence && a.condition == b.condition; };
    const auto isKnown = [&](const EnvelopeScore& other)
    {
        return std::any_of(
            scores.begin(),
            scores.end(),
            [&](const EnvelopeScore& s)
            { return isSameCell(s, other) && s.method == other.method; });
    };
    std::vector<EnvelopeScore> out;
    for (std::size_t k = 0; k < scores.size(); ++k)
    {
        out.push_back(scores[k]);
        if (k + 1 < scores.size() && isSameCell(scores[k], scores[k + 1]))
        {
            continue;
        }
        for (const EnvelopeScore& other : others)
        {
            if (isSameCell(other, scores[k]) && !isKnown(other))
            {
                out.push_back(other);
                out.back().truth = scores[k].truth;
            }
        }
    }
    return out;
}

std::string failuresCsv(const std::vector<EnvelopeScore>& scores)
{
    std::string out =
        "sequence,condition,method,run,frame,stamp,error_mm,error_deg,sigma_mm,sigma_deg,nees,"
        "beyond_5_sigma\n";
    for (const EnvelopeScore& s : scores)
    {
        std::vector<ScoredStep> steps = s.beyond;
        std::copy_if(
            s.large.begin(),
            s.large.end(),
            std::back_inserter(steps),
            [](const ScoredStep& step) { return !step.isBeyond; });
        for (const ScoredStep& step : steps)
        {
            out += s.sequence + "," + s.condition + "," + s.method +
                   text(
                       ",%zu,%zu,%.6f,%.1f,%.2f,%.2f,%.3f,%.1f,%d\n",
                       step.run,
                       step.frame,
                       step.stamp,
                       mm(step.errorTranslation),
                       degrees(step.errorRotation),
                       mm(step.sigmaTranslation),
                       degrees(step.sigmaRotation),
                       step.nees,
                       step.isBeyond ? 1 : 0);
        }
    }
    return out;
}
}  // namespace pointplane
