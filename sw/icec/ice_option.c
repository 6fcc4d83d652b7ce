/* SPDX-License-Identifier: MIT
 *
 * ice_option: options in proxy and endpoint strings: "-h host -p 10000 -v 'a b'".
 */
#include "ice_port.h"

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
