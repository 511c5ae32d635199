"""Camera messages as pictures for the screen: decoded, coloured, thinned out; never trusted.

Other rooms may import `reading` for any message with a picture, `images` and `picture` for drawing,
and the errors of `pixels`.
"""
