/* SPDX-License-Identifier: MIT
 *
 * ice_option: options in proxy and endpoint strings: "-h host -p 10000 -v 'a b'".
 */
#include "ice_seam.h"

#include <stdlib.h>

/* Where nothing is quoted. */
static const char* findPlain(const char* options, char letter) {
    while (options && *options) {
        if (options[0] == '-' && options[1] == letter)
            return options + 3;
        ++options;
    }
    return 0;
}

const char* Ice_findOption(const char* options, char letter, Ice_Int* size) {
    int matches = 0; /* the word before was "-x" */
    while (options && *options && *options != ':') {
        const char* begin;
        char quote = 0;
        if (*options == ' ') {
            ++options;
            continue;
        }
        if (*options == '"' || *options == '\'')
            quote = *options++;
        begin = options;
        while (*options && (quote ? *options != quote : *options != ' ' && *options != ':'))
            ++options;
        *size = (Ice_Int)(options - begin);
        if (matches)
            return begin;
        matches = !quote && *size == 2 && begin[0] == '-' && begin[1] == letter;
        if (quote && *options)
            ++options;
    }
    return 0;
}

U32 Ice_numberOption(const char* options, char letter, U32 otherwise) {
    Ice_Int size;
    const char* at =
        ICEC_DETAILS ? Ice_findOption(options, letter, &size) : findPlain(options, letter);
    if (!at)
        return otherwise;
    return (U32)strtoul(at, 0, at[0] == '0' && at[1] == 'x' ? 16 : 10);
}
