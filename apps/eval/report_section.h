// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/HtmlReport.h>
#include <pointplane/mrpt_io/errors.h>

#include <stdexcept>
#include <string>

namespace pointplane
{
/** Adds what `section` makes, or a paragraph that says why it could not. */
template <class Section>
void addSection(HtmlReport& report, const char* what, Section section)
{
    try
    {
        section();
    }
    catch (const EnvironmentError&)
    {
        throw;
    }
    catch (const std::runtime_error& error)
    {
        report.addParagraph(std::string("No ") + what + ": " + error.what() + ".");
    }
}
}  // namespace pointplane
