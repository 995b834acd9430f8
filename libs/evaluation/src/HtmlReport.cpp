// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/read_errors.h>
#include <pointplane/evaluation/HtmlReport.h>
#include <pointplane/evaluation/svg_chart.h>

#include <cctype>
#include <cstdint>
#include <fstream>
#include <stdexcept>

#include "report_page.h"

namespace pointplane
{
namespace
{
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

namespace
{
/** Columns of words, as opposed to numbers. */
std::vector<bool> textColumns(std::size_t number, const std::vector<std::vector<std::string>>& rows)
{
    std::vector<bool> out(number, !rows.empty());
    for (const auto& row : rows)
    {
        for (std::size_t k = 0; k < row.size(); ++k)
        {
            out[k] = out[k] && std::isalpha(static_cast<unsigned char>(row[k][0])) != 0;
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
    body_ += "<section class=\"wide\"><p>" + xmlEscaped(text) + "</p></section>\n";
}

void HtmlReport::addDetails(const std::string& caption, const std::string& text)
{
    body_ += "<section class=\"wide\"><details><summary>" + xmlEscaped(caption) +
             "</summary><pre>" + xmlEscaped(text) + "</pre></details></section>\n";
}

void HtmlReport::addTable(
    const std::string& caption,
    const std::vector<std::string>& header,
    const std::vector<std::vector<std::string>>& rows,
    const std::string& detail)
{
    body_ += "<section class=\"wide\"><h2>" + xmlEscaped(caption) + "</h2>" +
             (detail.empty() ? "" : "<p class=\"detail\">" + xmlEscaped(detail) + "</p>") +
             "<div class=\"scroll\"><table><tr>";
    const std::vector<bool> isText = textColumns(header.size(), rows);
    for (std::size_t k = 0; k < header.size(); ++k)
    {
        body_ += std::string("<th scope=\"col\"") + (isText[k] ? " class=\"text\">" : ">") +
                 xmlEscaped(header[k]) + "</th>";
    }
    body_ += "</tr>\n";
    for (const auto& row : rows)
    {
        body_ += "<tr>";
        for (std::size_t k = 0; k < row.size(); ++k)
        {
            body_ += (isText[k] ? "<td class=\"text\">" : "<td>") + xmlEscaped(row[k]) + "</td>";
        }
        body_ += "</tr>\n";
    }
    body_ += "</table></div></section>\n";
}

void HtmlReport::addChart(const Chart& chart)
{
    body_ += std::string("<section") + (chart.small ? " class=\"small\"" : "") + "><h2>" +
             xmlEscaped(chart.title) + "</h2>" + svgOf(chart) + "</section>\n";
    charts_.push_back(chart);
}

void HtmlReport::addPicture(const std::string& caption, const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    const std::string bytes = readAll(file);
    if (file.bad() || bytes.empty())
    {
        throw std::runtime_error("cannot read picture '" + path + "'");
    }
    const bool isPng = bytes.compare(1, 3, "PNG") == 0;
    body_ += "<section><h2>" + xmlEscaped(caption) + "</h2><img alt=\"" + xmlEscaped(caption) +
             "\" src=\"data:image/" + (isPng ? "png" : "jpeg") + ";base64," + base64(bytes) +
             "\"></section>\n";
}

std::string HtmlReport::html() const
{
    std::string out =
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<title>" +
        xmlEscaped(title_) + "</title>\n<style>";
    out += kReportStyle;
    out += chartStyle(false) + "@media screen and (prefers-color-scheme:dark){\n" +
           chartStyle(true) + "}\n</style></head>\n<body><header><h1>" + xmlEscaped(title_) +
           "</h1><p>" + xmlEscaped(subtitle_) + "</p></header>\n<main>\n" + body_ +
           "</main>\n<div id=\"reading\"></div>\n<script>\n";
    out += kReportScript;
    out += "</script>\n</body></html>\n";
    return out;
}
}  // namespace pointplane
