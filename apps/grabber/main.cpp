// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "GrabberApp.h"

int main(int argc, char** argv)
{
    return pointplane::runGrabber({argv + 1, argv + argc}, std::cout, std::cerr);
}
