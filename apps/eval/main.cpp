// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "EvalApp.h"

int main(int argc, char** argv)
{
    return pointplane::runEval({argv + 1, argv + argc}, std::cout, std::cerr);
}
