// The particles as the search left them.
#import common/vector
#import fields/position
#import fields/velocity
#import fields/id
