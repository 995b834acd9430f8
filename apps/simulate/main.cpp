// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "SimulateApp.h"

int main(int argc, char** argv)
{
    return pointplane::runSimulate({argv + 1, argv + argc}, std::cout, std::cerr);
}
