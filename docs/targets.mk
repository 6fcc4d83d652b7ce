# SPDX-License-Identifier: MIT

pictures: $(BUILD)/build.ninja ## take the pictures of README.md and docs/ anew: missions, and the pages of make synth and make regress
	@docs/pictures/take.sh
.PHONY: pictures
