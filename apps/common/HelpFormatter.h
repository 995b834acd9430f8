// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include <CLI/CLI.hpp>

namespace pointplane
{
/** Lines of help, broken between words. What follows stands below the descriptions.
 * \param columns 0: nothing is broken
 * \param indent where descriptions begin */
[[nodiscard]] std::string wrappedHelp(
    const std::string& text, std::size_t columns, std::size_t indent);

/** Help without what CLI11 adds and nobody can use: the values of flags (--wait{1e9}), a type told
 * twice (INT:INT in [1 - 9]), dots behind options that take one value at a time. */
class HelpFormatter : public CLI::Formatter
{
 public:
    /** \param columns see wrappedHelp() */
    explicit HelpFormatter(std::size_t columns) : columns_(columns) {}

    [[nodiscard]] std::string make_option(
        const CLI::Option* option, bool isPositional) const override;
    [[nodiscard]] std::string make_description(const CLI::App* app) const override;
    [[nodiscard]] std::string make_subcommand(const CLI::App* command) const override;
    [[nodiscard]] std::string make_option_name(
        const CLI::Option* option, bool isPositional) const override;
    [[nodiscard]] std::string make_option_opts(const CLI::Option* option) const override;

 private:
    std::size_t columns_;
};
}  // namespace pointplane
