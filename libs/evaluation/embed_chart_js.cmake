# Writes OUTPUT, a C++ source whose chartJs() returns the bytes of INPUT.
file(READ "${INPUT}" bytes HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
file(WRITE "${OUTPUT}" "#include \"report_page.h\"
namespace pointplane
{
namespace
{
const unsigned char kBytes[] = {${bytes}0};
}
std::string_view chartJs()
{
    return {reinterpret_cast<const char*>(kBytes), sizeof(kBytes) - 1};
}
}  // namespace pointplane
")
