// SPDX-License-Identifier: BSD-3-Clause
// pointplane-adversary [share]: prints the table of docs/robustness.md, and every failure on the
// standard error. share: of the full number of attempts, 0 to 1. Exit code 1 if anything failed.
#include <cstdlib>
#include <iostream>

#include "Attempt.h"

int main(int argc, char** argv)
{
    using namespace pointplane::adversary;
    const double share = argc > 1 ? std::atof(argv[1]) : 1.0;
    std::cout << Tally::header();
    int code = 0;
    for (const auto kind :
         {damagedRawlogs, damagedFolders, iniValues, fullDisks, sameFiles, mrptSamples})
    {
        const Tally tally = kind(share);
        std::cout << tally.row() << std::flush;
        for (const std::string& failure : tally.failures())
        {
            std::cerr << failure << "\n";
            code = 1;
        }
    }
    return code;
}
