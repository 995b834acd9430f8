// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "ConvertApp.h"

int main(int argc, char** argv)
{
    return pointplane::runConvert({argv + 1, argv + argc}, std::cout, std::cerr);
}
