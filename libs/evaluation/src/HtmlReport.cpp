// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/HtmlReport.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "report_page.h"
#include <nlohmann/json.hpp>

namespace pointplane
{
namespace
{
constexpr std::size_t kMaxPoints = 3000;

std::string escaped(const std::string& text)
{
    std::string out;
    for (const char c : text)
    {
        switch (c)
        {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                out += c;
        }
    }
    return out;
}

/** Indices to keep: of each bucket the first, the lowest and the highest. */
std::vector<std::size_t> thinned(const std::vector<double>& y)
{
    const std::size_t stride = std::max<std::size_t>(1, 3 * y.size() / kMaxPoints);
    std::vector<std::size_t> keep;
    for (std::size_t begin = 0; begin < y.size(); begin += stride)
    {
        const auto from = y.begin() + static_cast<std::ptrdiff_t>(begin);
        const auto to = y.begin() + static_cast<std::ptrdiff_t>(std::min(begin + stride, y.size()));
        const auto [low, high] = std::minmax_element(from, to);
        std::vector<std::size_t> bucket{
            begin,
            static_cast<std::size_t>(low - y.begin()),
            static_cast<std::size_t>(high - y.begin())};
        std::sort(bucket.begin(), bucket.end());
        bucket.erase(std::unique(bucket.begin(), bucket.end()), bucket.end());
        keep.insert(keep.end(), bucket.begin(), bucket.end());
    }
    if (!keep.empty() && keep.back() != y.size() - 1)
    {
        keep.push_back(y.size() - 1);
    }
    return keep;
}

/** Six significant digits keep the file small; JSON has no NaN, null stands for it. */
nlohmann::json shortNumber(double value)
{
    if (!std::isfinite(value))
    {
        return nullptr;
    }
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return std::strtod(text, nullptr);
}

nlohmann::json toJson(const ChartSeries& series)
{
    static const char* const kStyles[] = {"line", "points", "steps", "dashed"};
    nlohmann::json json;
    json["name"] = series.name;
    json["style"] = kStyles[static_cast<std::size_t>(series.style)];
    json["rightAxis"] = series.rightAxis;
    json["colour"] = series.colour;
    json["x"] = nlohmann::json::array();
    json["y"] = nlohmann::json::array();
    for (const std::size_t k : thinned(series.y))
    {
        json["x"].push_back(shortNumber(series.x[k]));
        json["y"].push_back(shortNumber(series.y[k]));
    }
    return json;
}

std::string base64(const std::string& bytes)
{
    static const char* const kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t k = 0; k < bytes.size(); k += 3)
    {
        std::uint32_t group = 0;
        for (std::size_t m = 0; m < 3; ++m)
        {
            const auto byte = k + m < bytes.size() ? static_cast<unsigned char>(bytes[k + m]) : 0U;
            group = (group << 8) | byte;
        }
        for (std::size_t m = 0; m < 4; ++m)
        {
            out += k + m <= bytes.size() ? kDigits[(group >> (18 - 6 * m)) & 63U] : '=';
        }
    }
    return out;
}
}  // namespace

HtmlReport::HtmlReport(std::string title, std::string subtitle)
    : title_(std::move(title)), subtitle_(std::move(subtitle))
{
}

void HtmlReport::addParagraph(const std::string& text)
{
    body_ += "<section class=\"wide\"><p>" + escaped(text) + "</p></section>\n";
}

void HtmlReport::addTable(
    const std::string& caption,
    const std::vector<std::string>& header,
    const std::vector<std::vector<std::string>>& rows)
{
    body_ += "<section class=\"wide\"><h2>" + escaped(caption) +
             "</h2><div class=\"scroll\"><table><tr>";
    for (const std::string& cell : header)
    {
        body_ += "<th>" + escaped(cell) + "</th>";
    }
    body_ += "</tr>\n";
    for (const auto& row : rows)
    {
        body_ += "<tr>";
        for (const std::string& cell : row)
        {
            body_ += "<td>" + escaped(cell) + "</td>";
        }
        body_ += "</tr>\n";
    }
    body_ += "</table></div></section>\n";
}

void HtmlReport::addChart(const Chart& chart)
{
    nlohmann::json json;
    json["xLabel"] = chart.xLabel;
    json["yLabel"] = chart.yLabel;
    json["yRightLabel"] = chart.yRightLabel;
    json["equalScales"] = chart.equalScales;
    json["logX"] = chart.logX;
    json["logY"] = chart.logY;
    json["xNames"] = chart.xNames;
    json["yNames"] = chart.yNames;
    json["series"] = nlohmann::json::array();
    for (const ChartSeries& series : chart.series)
    {
        json["series"].push_back(toJson(series));
    }
    body_ += "<section><h2>" + escaped(chart.title) + "</h2><div class=\"plot" +
             (chart.equalScales ? " map" : "") + "\"><canvas id=\"chart" +
             std::to_string(charts_.size()) + "\" role=\"img\" aria-label=\"" +
             escaped(chart.title) + "\"></canvas></div></section>\n";
    std::string text = json.dump();
    // "</script>" in a name would end the script.
    for (std::size_t at = 0; (at = text.find("</", at)) != std::string::npos; at += 3)
    {
        text.replace(at, 2, "<\\/");
    }
    charts_.push_back(std::move(text));
}

void HtmlReport::addPicture(const std::string& caption, const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (!file || bytes.empty())
    {
        throw std::runtime_error("cannot read picture '" + path + "'");
    }
    const bool isPng = bytes.compare(1, 3, "PNG") == 0;
    body_ += "<section><h2>" + escaped(caption) + "</h2><img alt=\"" + escaped(caption) +
             "\" src=\"data:image/" + (isPng ? "png" : "jpeg") + ";base64," + base64(bytes) +
             "\"></section>\n";
}

std::string HtmlReport::html() const
{
    std::string out =
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<title>" +
        escaped(title_) + "</title>\n<style>";
    out += kReportStyle;
    out += "</style></head>\n<body><header><h1>" + escaped(title_) + "</h1><p>" +
           escaped(subtitle_) + "</p></header>\n<main>\n" + body_ + "</main>\n<script>\n";
    out += chartJs();
    out += "\n</script>\n<script>\nconst charts = [";
    for (std::size_t k = 0; k < charts_.size(); ++k)
    {
        out += (k == 0 ? "\n" : ",\n") + charts_[k];
    }
    out += "];\n";
    out += kReportScript;
    out += "</script>\n</body></html>\n";
    return out;
}
}  // namespace pointplane
