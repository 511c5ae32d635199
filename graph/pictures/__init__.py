"""Camera messages as pictures to be shown: decoded, coloured, thinned out; never trusted.

From outside: `reading` for any message with a picture, `images` and `picture` for what is drawn,
and the errors of `pixels`.
"""
