// SPDX-License-Identifier: BSD-3-Clause
// pointplane-adversary [share [kind]]: prints the table of docs/robustness.md, and every failure on
// the standard error. share: of the full number of attempts, 0 to 1. kind: this row alone, counted
// from 0. Exit code 1 if anything failed, 2 if there is no such kind.
#include <cstdlib>
#include <iostream>
#include <vector>

#include "Attempt.h"

int main(int argc, char** argv)
{
    using namespace pointplane::adversary;
    const double share = argc > 1 ? std::atof(argv[1]) : 1.0;
    const std::vector<Tally (*)(double)> kinds{
        damagedRawlogs,
        damagedFolders,
        iniValues,
        optionValues,
        fullDisks,
        fullDisksOfGrabber,
        tightLimits,
        sameFiles,
        mrptSamples};
    const std::size_t only = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : kinds.size();
    if (argc > 2 && only >= kinds.size())
    {
        return 2;
    }
    if (argc < 3)
    {
        std::cout << Tally::header();
    }
    int code = 0;
    for (std::size_t k = 0; k < kinds.size(); ++k)
    {
        if (argc > 2 && k != only)
        {
            continue;
        }
        const Tally tally = kinds[k](share);
        std::cout << tally.row() << std::flush;
        for (const std::string& failure : tally.failures())
        {
            std::cerr << failure << "\n";
            code = 1;
        }
    }
    return code;
}
