"""Camera messages as pictures to be shown: decoded, coloured, thinned out; never trusted."""
