// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/Chart.h>

#include <string>
#include <vector>

namespace pointplane
{
/** A report in one HTML file that needs nothing else: no network, no further file. Charts and
 * pictures are part of it. Fits a phone, a desk and paper, light and dark. */
class HtmlReport
{
 public:
    HtmlReport(std::string title, std::string subtitle);

    void addParagraph(const std::string& text);
    /** Text in its own layout (a configuration, say) that the reader can unfold. */
    void addDetails(const std::string& caption, const std::string& text);
    /** \param detail below the caption: how the figures were made, say */
    void addTable(
        const std::string& caption,
        const std::vector<std::string>& header,
        const std::vector<std::vector<std::string>>& rows,
        const std::string& detail = "");
    /** See svgOf(). */
    void addChart(const Chart& chart);
    /** Embeds a PNG or JPEG file. \throws std::runtime_error naming it if it cannot be read */
    void addPicture(const std::string& caption, const std::string& path);

    [[nodiscard]] std::string html() const;

    /** The charts so far, in order. */
    [[nodiscard]] const std::vector<Chart>& charts() const { return charts_; }

 private:
    std::string title_, subtitle_;
    std::string body_;
    std::vector<Chart> charts_;
};
}  // namespace pointplane
