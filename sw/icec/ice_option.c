/* SPDX-License-Identifier: MIT
 *
 * ice_option: reads options in endpoint strings, such as "-h host -p 10000 -v 'a b'".
 *
 * As in Ice, the value of an option does not begin with '-', and if an option occurs twice, the
 * last one counts. Quotes must enclose a whole word.
 */
#include "ice_private.h"

#include <string.h>

/* Finds the next word of the options, and removes its quotes. Returns the text after the word. At
 * the end of the options, returns 0. If a quote is not closed, returns 0 and sets `size` to -1. */
static const char* nextWord(const char* text, const char** word, Ice_Int* size) {
    char quote = 0;
    *size = 0;
    do {
        if (*text && strchr(ICEC_SPACES, *text))
            ++text;
        else if (text[0] && text[0] == text[1] && strchr("'\"", *text))
            text += 2; /* an empty word is skipped */
        else
            break;
    } while (1);
    if (*text == 0 || *text == ':')
        return 0;
    if (*text == '"' || *text == '\'')
        quote = *text++;
    *word = text;
    /* A colon ends the endpoint even if the colon is within single quotes. */
    text += strcspn(text, quote == '"' ? "\"" : quote ? "':" : ICEC_SPACES ":'\"");
    *size = (Ice_Int)(text - *word);
    if (quote && *text == quote && text[-1] != '\\')
        ++text;
    else if (quote)
        *size = -1;
    if (*text && strchr(ICEC_SPACES ":", *text) == 0)
        *size = -1; /* a quote is only allowed at the start of a word */
    return *size < 0 ? 0 : text;
}

Ice_Bool Ice_areOptions(const char* options, const char* letters) {
    const char *word, *known = 0;
    Ice_Int size;
    for (;;) {
        options = nextWord(options, &word, &size);
        if (!options)
            return size == 0 && !known;
        if (!letters)
            continue;
        if (*word != '-') { /* a value */
            if (!known)
                return 0;
            known = 0;
        } else {
            if (known || size != 2 || word[1] == '-')
                return 0;
            known = strchr(letters, word[1]);
            if (!known)
                return 0;
            if (known[1] == '-')
                known = 0;
        }
    }
}

const char* Ice_findOption(const char* options, char letter, Ice_Int* size) {
    const char *word, *found = 0;
    Ice_Int length;
    int matches = 0; /* 1 if the previous word was the option that is searched for */
    while (options && (options = nextWord(options, &word, &length)) != 0) {
        if (matches) {
            found = word;
            *size = length;
        }
        matches = length == 2 && word[0] == '-' && word[1] == letter;
    }
    return found;
}

Ice_Bool Ice_hasOption(const char* options, char letter) {
    const char* word;
    Ice_Int size;
    while ((options = nextWord(options, &word, &size)) != 0)
        if (size == 2 && word[0] == '-' && word[1] == letter)
            return 1;
    return 0;
}

/* Reads a decimal number from 0 to `most`. Returns 0 if the word is not such a number. */
static Ice_Bool readInteger(const char* at, Ice_Int size, Ice_Int most, Ice_Int* value) {
    Ice_Int number = 0;
    while (size > 0 && strchr(ICEC_SPACES, *at))
        ++at, --size;
    if (size > 1 && *at == '+')
        ++at, --size;
    if (size == 0)
        return 0;
    for (; size > 0; ++at, --size) {
        if (*at < '0' || *at > '9' || number > (most - (*at - '0')) / 10)
            return 0;
        number = number * 10 + (*at - '0');
    }
    *value = number;
    return 1;
}

Ice_Bool Ice_integerOption(const char* options, char letter, Ice_Int most, Ice_Int* value) {
    const char* word;
    Ice_Int size;
    int matches = 0;
    while ((options = nextWord(options, &word, &size)) != 0) {
        if (matches && !readInteger(word, size, most, value))
            return 0;
        matches = size == 2 && word[0] == '-' && word[1] == letter;
    }
    return 1;
}
