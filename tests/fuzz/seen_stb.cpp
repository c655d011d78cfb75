// stb_image once more, in the fuzzer's own program, where it is instrumented and sanitised: the program links Debian's library of
// the same source. The linker takes the definitions here first.
#define STB_IMAGE_IMPLEMENTATION
#include <stb_image.h>
